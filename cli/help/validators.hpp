#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace vestige::help {

// CLI11 validators of numbers, which must be finite: CLI11's own let nan through.
extern const CLI::Validator kFinite;
/// Of a scenario's frames. Below, it has to live through thousands of seconds from one to the next; above, times in
/// nanoseconds coincide.
inline constexpr double kLeastRate_hz = 1e-3;
inline constexpr double kMostRate_hz = 1e9;

extern const CLI::Validator kPositive;
extern const CLI::Validator kNotNegative;
CLI::Validator between(double low, double high);
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

}  // namespace vestige::help
