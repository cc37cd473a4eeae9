// Our traces, read by the reference reader: npm's @mcap/core, fetched into tests/npm/node_modules when it is not there
// yet.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/test_data.hpp"
#include "tests/traces/trace_fixture.hpp"

namespace vestige {
namespace {

nlohmann::json seen_by_reference_reader(const std::filesystem::path& trace) {
  const std::string command =
      fmt::format("node '{}/tests/npm/read_trace.mjs' '{}'", VESTIGE_SOURCE_DIR, trace.string());
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string output;
  char block[4096];
  for (std::size_t count = 0; (count = std::fread(block, 1, sizeof block, pipe)) > 0;) output.append(block, count);
  EXPECT_EQ(::pclose(pipe), 0);
  return nlohmann::json::parse(output);
}

/// Where the reference reader is, or should be: without network it stays missing.
std::filesystem::path reference_reader() {
  const auto folder = std::filesystem::path(VESTIGE_SOURCE_DIR) / "tests/npm";
  auto module = folder / "node_modules/@mcap/core";
  if (!std::filesystem::exists(module)) {
    const std::string command = fmt::format("cd '{}' && npm ci --no-audit --no-fund >&2", folder.string());
    if (std::system(command.c_str()) != 0) std::fputs("npm ci failed\n", stderr);
  }
  return module;
}

TEST(ReferenceReader, SeesAllThatIsInATrace) {
  VESTIGE_REQUIRE_DATA(reference_reader());
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(test::kNodes);
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    TraceWriterOptions options = test::steady_options(5000);
    options.compression = compression;
    options.overwrite = Overwrite::kAllow;
    {
      TraceWriter writer(folder / "a.mcap", {{"argv", "vestige record"}}, test::skeleton(test::kNodes),
                         {.avatar_glb = glb, .actuator_map_json = "{}"}, options);
      for (std::uint64_t i = 0; i < 100; ++i) writer.write(test::frame(i, test::kNodes, test::kColliders));
      writer.note_marker("here");
      writer.finish();
    }
    const nlohmann::json seen = seen_by_reference_reader(folder / "a.mcap");
    EXPECT_EQ(seen["done"], true);
    EXPECT_EQ(seen["profile"], "vestige");
    EXPECT_EQ(seen["streamed"], seen["indexed"]);
    EXPECT_EQ(seen["indexed"]["/pose"], 100);
    EXPECT_EQ(seen["indexed"]["/colliders"], 100);
    EXPECT_EQ(seen["indexed"]["/events"], 1);
    EXPECT_EQ(seen["messageCount"], 201);
    EXPECT_EQ(seen["lastSequence"], 99);
    EXPECT_EQ(seen["channels"]["/pose"]["encoding"], "flatbuffer");
    EXPECT_EQ(nlohmann::json::parse(seen["channels"]["/pose"]["metadata"]["nodes"].get<std::string>()).size(), 3U);
    EXPECT_EQ(seen["schemas"]["vestige.trace.PoseFrame"]["encoding"], "flatbuffer");
    EXPECT_GT(seen["schemas"]["vestige.trace.ColliderFrame"]["bytes"], 100);
    EXPECT_EQ(seen["attachments"]["avatar.glb"], glb.size());
    EXPECT_EQ(seen["attachments"]["actuator_map.json"], 2);
    EXPECT_EQ(seen["metadata"]["session"]["argv"], "vestige record");
  }
}

}  // namespace
}  // namespace vestige
