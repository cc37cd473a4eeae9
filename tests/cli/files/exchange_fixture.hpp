#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/command_line.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::test {

/// A trace to export, and what is looked at in what comes of it.
class ExchangeTest : public CommandLineTest {
 protected:
  void SetUp() override {
    // Drops teleport, so that nothing may be lost on the way there and back.
    ASSERT_EQ(run("vestige record --colliders rain --count 30 --rate 200 --duration 1.5 --origin 1000.5,-3,7 "
                  "-o a.mcap")
                  .exit_code,
              0);
  }
  std::string hash_of(const std::string& trace) const {
    return json_of("vestige replay " + trace + " --detector cpu --json -")["texture_hash"];
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  void expect_no_hidden_file() const {
    EXPECT_EQ(run("ls -A | grep -c '^[.]'").standard_output, "0\n") << run("ls -A").standard_output;
  }
  /// Records what comes in these lines, as they are, without a map.
  void record_lines(const std::string& lines, const std::string& name) const {
    write("lines.ndjson", lines);
    ASSERT_EQ(run("vestige record --live - --map none --force -o " + name + " < lines.ndjson").exit_code, 0);
  }
  /// The JSON chunk of a GLB.
  nlohmann::json json_of_glb(const std::string& name) const {
    const std::string glb = read_text_file(folder_ / name);
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, sizeof length);
    return nlohmann::json::parse(glb.substr(20, length));
  }
};

}  // namespace vestige::test
