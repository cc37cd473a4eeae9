#include "analysis/plot/film/duty_columns.hpp"

#include <algorithm>

namespace vestige::plot {

namespace {

/// Times that are meant to begin a column land a hair beside it.
constexpr double kHair = 1e-6;

}  // namespace

DutyColumns::DutyColumns(std::size_t actuators, std::size_t columns, double begin_s, double end_s)
    : columns_(columns), begin_s_(begin_s), end_s_(end_s), last_(actuators), highest_(actuators * columns) {}

void DutyColumns::add(double time_s, std::span<const std::uint8_t> duty) {
  const double place = place_of(time_s);
  const auto column = static_cast<std::size_t>(place);
  hold_until(column);
  if (column < columns_ && place - static_cast<double>(column) > kHair) raise(column);  // what held until now
  std::ranges::copy(duty, last_.begin());
  if (column < columns_ && time_s >= begin_s_) raise(column);
}

void DutyColumns::finish() {
  hold_until(columns_);
}

void DutyColumns::hold_until(std::size_t column) {
  for (; last_column_ < column; ++last_column_) raise(last_column_);
}

void DutyColumns::raise(std::size_t column) {
  for (std::size_t actuator = 0; actuator < last_.size(); ++actuator) {
    std::uint8_t& highest = highest_[actuator * columns_ + column];
    highest = std::max(highest, last_[actuator]);
  }
}

double DutyColumns::place_of(double time_s) const {
  const double place = (time_s - begin_s_) / (end_s_ - begin_s_) * static_cast<double>(columns_);
  return std::clamp(place, 0.0, static_cast<double>(columns_));
}

}  // namespace vestige::plot
