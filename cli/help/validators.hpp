#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace vestige::help {

// CLI11 validators of numbers, which must be finite: CLI11's own let nan through.
extern const CLI::Validator kFinite;
extern const CLI::Validator kPositive;
extern const CLI::Validator kNotNegative;
CLI::Validator between(double low, double high);
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);

}  // namespace vestige::help
