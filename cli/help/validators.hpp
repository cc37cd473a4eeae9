#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace vestige::help {

// CLI11 validators of finite numbers. CLI11's own validators accept nan.
extern const CLI::Validator kFinite;
/// The range of a scenario's frame rate. Below it, a scenario has to simulate thousands of seconds from one frame to
/// the next. Above it, times in nanoseconds coincide.
inline constexpr double kLeastRate_hz = 1e-3;
inline constexpr double kMostRate_hz = 1e9;

extern const CLI::Validator kPositive;
extern const CLI::Validator kNotNegative;
CLI::Validator between(double low, double high);
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

}  // namespace vestige::help
