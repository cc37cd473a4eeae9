#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/test_data.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::test {

/// Runs commands as a user does, in a new empty folder.
class CommandLineTest : public ::testing::Test {
 protected:
  Outcome run(const std::string& command) const { return test::run(command, folder_.path()); }

  /// Runs a command that must succeed. Returns the JSON that it prints.
  nlohmann::json json_of(const std::string& command) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.standard_error;
    return nlohmann::json::parse(outcome.standard_output, nullptr, false);
  }

  /// Writes a file.
  void write(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void write(const std::string& name, const std::string& text) const { write(name, std::as_bytes(std::span(text))); }

  /// Returns the content of a JSON file.
  nlohmann::json json_in(const std::string& file) const {
    return nlohmann::json::parse(read_text_file(folder_ / file), nullptr, false);
  }

  /// Expects that the command fails with this exit code, prints each of these words, and leaves no file named `absent`.
  void expect_failure(const std::string& command, int exit_code, const std::vector<std::string>& words,
                      const std::string& absent = "") const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, exit_code) << command << "\n" << outcome.standard_error;
    EXPECT_THAT(outcome.standard_error, ::testing::StartsWith("vestige: ")) << command;
    for (const std::string& word : words) EXPECT_THAT(outcome.standard_error, ::testing::HasSubstr(word)) << command;
    if (absent.empty()) return;
    EXPECT_FALSE(std::filesystem::exists(folder_ / absent)) << command;
  }

  /// Records a trace of 20 colliders and 60 frames.
  void record_small(const std::string& name = "small.mcap") const {
    ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 -o " + name).exit_code, 0);
  }

  const TemporaryFolder folder_;
};

}  // namespace vestige::test
