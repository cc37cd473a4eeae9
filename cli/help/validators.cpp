#include "cli/help/validators.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <string>

namespace vestige::help {

namespace {

/// `expected` follows "is not a finite number".
CLI::Validator number_check(const std::function<bool(double)>& is_good, const std::string& expected,
                            const std::string& shown) {
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure == std::errc() && end == text.data() + text.size() && std::isfinite(value) && is_good(value))
          return std::string();
        return fmt::format("'{}' is not a finite number{}", text, expected);
      },
      shown);
}

}  // namespace

const CLI::Validator kFinite = number_check([](double) { return true; }, "", "");
const CLI::Validator kPositive = number_check([](double value) { return value > 0; }, " above 0", "above 0");
const CLI::Validator kNotNegative =
    number_check([](double value) { return value >= 0; }, " of at least 0", "at least 0");

CLI::Validator between(double low, double high) {
  const std::string range = fmt::format("{} to {}", low, high);
  return number_check([=](double value) { return value >= low && value <= high; }, " from " + range, range);
}

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t value = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure == std::errc() && end == text.data() + text.size() && value >= low && value <= high)
          return std::string();
        return fmt::format("'{}' is not a whole number from {} to {}", text, low, high);
      },
      fmt::format("{} to {}", low, high));
}

}  // namespace vestige::help
