#pragma once

#include <CLI/CLI.hpp>

namespace vestige::help {

// CLI11 validators of numbers, which must be finite: CLI11's own let nan through.
extern const CLI::Validator kFinite;
extern const CLI::Validator kPositive;
extern const CLI::Validator kNotNegative;
CLI::Validator between(double low, double high);

}  // namespace vestige::help
