#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace vestige::test {

/// Returns the path of a file or folder of the real test data.
inline std::filesystem::path data(const std::filesystem::path& relative) {
  return std::filesystem::path(VESTIGE_DATA_DIR) / relative;
}

/// A new empty folder. The destructor removes it with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "vestige-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace vestige::test

/// Skips the test with the missing path in the message if real data is absent. Under CI, fails instead.
#define VESTIGE_REQUIRE_DATA(path)                                                     \
  if (!std::filesystem::exists(path)) {                                                \
    if (std::getenv("CI") != nullptr) FAIL() << "test data is missing: " << (path);    \
    GTEST_SKIP() << "test data is missing: " << (path) << "; nothing was tested here"; \
  }
