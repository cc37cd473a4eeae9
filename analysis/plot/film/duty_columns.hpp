#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vestige::plot {

/// The highest duty of each actuator in each column of a timeline, however many frames there are.
class DutyColumns {
 public:
  /// Columns are equally long, and last from `begin_s` until `end_s`, which is later. Each number is at least 1.
  DutyColumns(std::size_t actuators, std::size_t columns, double begin_s, double end_s);

  /// Takes the duties of the next frame, which hold until the frame after it. Times may be outside of the timeline.
  void add(double time_s, std::span<const std::uint8_t> duty);
  /// The last duties hold until the end.
  void finish();

  /// Returns `columns` duties for each actuator.
  const std::vector<std::uint8_t>& highest() const { return highest_; }

 private:
  void hold_until(std::size_t column);
  void raise(std::size_t column);
  /// Returns the place of a time, in columns; `columns_` behind the end, and 0 before the beginning.
  double place_of(double time_s) const;

  std::size_t columns_;
  double begin_s_;
  double end_s_;
  std::vector<std::uint8_t> last_;
  std::size_t last_column_ = 0;
  std::vector<std::uint8_t> highest_;
};

}  // namespace vestige::plot
