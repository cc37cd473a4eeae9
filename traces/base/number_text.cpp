#include "traces/base/number_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace vestige {

namespace {

template <typename Number>
void append_number(std::string& out, Number value) {
  if (!std::isfinite(value)) {
    out += std::isnan(value) ? "\"nan\"" : value > 0 ? "\"inf\"" : "\"-inf\"";
  } else if (value == 0 && std::signbit(value)) {
    out += "-0.0";  // a reader would take -0 for an integer, which has no negative zero
  } else {
    fmt::format_to(std::back_inserter(out), "{}", value);
  }
}

}  // namespace

void append_json(std::string& out, float value) {
  append_number(out, value);
}

void append_json(std::string& out, double value) {
  append_number(out, value);
}

void append_json(std::string& out, const glm::dvec3& vector) {
  out += '[';
  append_number(out, vector.x);
  out += ',';
  append_number(out, vector.y);
  out += ',';
  append_number(out, vector.z);
  out += ']';
}

void append_seconds(std::string& out, std::int64_t time_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  fmt::format_to(std::back_inserter(out), "{}", time_ns / kSecond);
  if (time_ns % kSecond == 0) return;
  fmt::format_to(std::back_inserter(out), ".{:09}", time_ns % kSecond);
  out.erase(out.find_last_not_of('0') + 1);
}

std::int64_t nanoseconds_of(double time_s) {
  return std::llround(time_s * 1e9);
}

std::string percent_text(double share) {
  return share < 0.1 ? fmt::format("{:.2g}", 100 * share) : fmt::format("{:.0f}", 100 * share);
}

std::string counted(std::uint64_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string listed(std::span<const std::string> words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 == words.size() ? " and " : ", ";
    list += words[i];
  }
  return list;
}

}  // namespace vestige
