#include "analysis/plot/film/duty_columns.hpp"

#include <algorithm>

namespace vestige::plot {

DutyColumns::DutyColumns(std::size_t actuators, std::size_t columns, double begin_s, double end_s)
    : columns_(columns), begin_s_(begin_s), end_s_(end_s), last_(actuators), highest_(actuators * columns) {}

void DutyColumns::add(double time_s, std::span<const std::uint8_t> duty) {
  const std::size_t column = column_of(time_s);
  hold_until(column);
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

std::size_t DutyColumns::column_of(double time_s) const {
  const double column = (time_s - begin_s_) / (end_s_ - begin_s_) * static_cast<double>(columns_);
  return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(columns_)));
}

}  // namespace vestige::plot
