#pragma once

#include <cstdint>
#include <vector>

namespace vestige::test {

/// A pin has this duty from then on.
struct DutyChange {
  std::uint64_t cycle = 0;
  std::uint8_t duty = 0;  ///< 256ths of a period; 255 where the pin stays high
  bool operator==(const DutyChange&) const = default;
};

/// Turns a pin's edges into duties. A duty counts from its first whole period, rising edge to rising edge; 0 and 255
/// from the last edge, once the pin has kept its level for longer than a period. Periods cut short by a change are
/// none.
class PinDuty {
 public:
  /// One period of the firmware's PWM in cycles of the microcontroller: 256 steps of its clock / 64.
  static constexpr std::uint64_t kPeriod_cycles = 256 * 64;

  /// Cycles never go back. Calls that change nothing are welcome.
  void set(std::uint64_t cycle, bool high);
  /// Says that nothing has happened until now: a constant level becomes known.
  void advance(std::uint64_t cycle);

  bool high() const { return high_; }
  /// How long the pin has been high since the start.
  std::uint64_t high_cycles(std::uint64_t now) const;
  /// In order, each unlike the one before it. It starts with duty 0 at cycle 0.
  const std::vector<DutyChange>& changes() const { return changes_; }

 private:
  void note(std::uint64_t cycle, std::uint8_t duty);

  bool high_ = false;
  std::uint64_t last_edge_ = 0;
  std::uint64_t last_rise_ = 0;
  std::uint64_t high_cycles_ = 0;  ///< until the last edge
  std::uint64_t pulse_ = 0;        ///< the last high time, within the period that began with last_rise_
  std::vector<DutyChange> changes_ = {{0, 0}};
};

}  // namespace vestige::test
