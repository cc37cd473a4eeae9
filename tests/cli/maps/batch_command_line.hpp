#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command_line.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige::test {

/// Batches as a user runs them.
class BatchCommandLine : public CommandLineTest {
 protected:
  /// One-second traces of twenty colliders.
  void record(const std::vector<std::string>& names) const {
    int seed = 0;
    for (const std::string& name : names)
      ASSERT_EQ(
          run("vestige record --count 20 --rate 100 --duration 1 --seed " + std::to_string(++seed) + " -o " + name)
              .exit_code,
          0);
  }

  /// Everything that must be the same bytes for equal work.
  void expect_same_results(const std::string& a, const std::string& b) const {
    EXPECT_EQ(run("diff -r --exclude=run.json --exclude=times --exclude=.lock " + a + " " + b).standard_output, "");
    for (const char* name : {"scores.csv", "scores.json", "ranking.csv", "ranking.json"})
      EXPECT_TRUE(std::filesystem::exists(folder_ / a / name)) << name;
  }

  void write_map(const std::string& name) const {
    const auto png = builtin_actuator_map_png();
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  }
};

}  // namespace vestige::test
