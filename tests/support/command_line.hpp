#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/process.hpp"
#include "tests/support/test_data.hpp"

namespace vestige::test {

/// Runs commands as a user does, in an empty folder of its own.
class CommandLineTest : public ::testing::Test {
 protected:
  Outcome run(const std::string& command) const { return test::run(command, folder_.path()); }

  /// What a command that must succeed prints.
  nlohmann::json json_of(const std::string& command) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.standard_error;
    return nlohmann::json::parse(outcome.standard_output, nullptr, false);
  }

  const TemporaryFolder folder_;
};

}  // namespace vestige::test
