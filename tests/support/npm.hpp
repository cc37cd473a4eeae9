#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace vestige::test {

/// Returns the path of a package of tests/npm. Fetches the packages if they are missing or older than
/// package-lock.json. Without network, the package stays missing.
inline std::filesystem::path npm_package(const std::string& name) {
  const auto folder = std::filesystem::path(VESTIGE_SOURCE_DIR) / "tests/npm";
  // Test programs run in parallel: one of them fetches, and the others wait until the fetch is done. npm writes
  // .package-lock.json last, when every package is complete. A registry may be unreachable for a moment, so the fetch
  // is tried three times.
  const std::string command = fmt::format(
      "cd '{}' && flock package.json sh -c "
      "'for pause in 0 5 20; do test node_modules/.package-lock.json -nt package-lock.json && exit 0; sleep $pause; "
      "npm ci --no-audit --no-fund >&2 && exit 0; done; rm -rf node_modules; exit 1'",
      folder.string());
  if (std::system(command.c_str()) != 0) std::fputs("npm ci failed\n", stderr);
  return folder / "node_modules" / name;
}

/// Returns what a script of tests/npm prints about `file`.
inline std::string run_node(const std::string& script, const std::filesystem::path& file) {
  const std::string command = fmt::format("node '{}/tests/npm/{}' '{}'", VESTIGE_SOURCE_DIR, script, file.string());
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string output;
  char block[4096];
  for (std::size_t count = 0; (count = std::fread(block, 1, sizeof block, pipe)) > 0;) output.append(block, count);
  EXPECT_EQ(::pclose(pipe), 0);
  return output;
}

}  // namespace vestige::test
