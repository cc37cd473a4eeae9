#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/transport/firmware/pca9685.hpp"
#include "tests/transport/firmware/pin_duty.hpp"

struct avr_t;
struct avr_twi_t;
struct avr_irq_t;

namespace vestige::test {

/// What may hold the two-wire bus.
enum class BusFault : std::uint8_t {
  kNone,
  kSclLow,
  kSdaLow,
  kSdaLowUntilClocks,  ///< a chip that was cut short: it lets SDA go at the third clock that it gets
};

/// PCA9685 chips at the addresses 0x40, 0x41, … of a microcontroller's two-wire bus. Their common OE is at PD2, with a
/// resistor to the supply.
///
/// simavr's own bus takes 9 us for a byte at any speed, and never hangs. Here a bit takes the time that TWBR says, and
/// a line that is held low stops everything.
class PwmChips {
 public:
  explicit PwmChips(std::size_t chips);
  PwmChips(const PwmChips&) = delete;
  PwmChips& operator=(const PwmChips&) = delete;

  /// Connects the bus to a microcontroller that was just made, whose cycle 0 is `power_on_cycle`.
  void connect(avr_t* avr, std::uint64_t power_on_cycle);
  /// The chips lose their supply, and get it back.
  void power_cycle(std::uint64_t cycle);
  /// The microcontroller was reset, or its pins may have changed.
  void update();

  void set_fault(BusFault fault);
  /// A chip does not acknowledge any more, or does again. Its outputs stay as they are.
  void set_deaf(std::size_t chip, bool deaf) { deaf_[chip] = deaf; }

  std::size_t outputs() const { return changes_.size(); }
  const Pca9685& chip(std::size_t number) const { return chips_[number]; }
  /// Counts of 4096 in which the output is high now.
  unsigned high_counts(std::size_t output) const;
  /// Duties in order, each unlike the one before it: 256ths, rounded, of a period; 255 if the output stays high.
  const std::vector<DutyChange>& changes(std::size_t output) const { return changes_[output]; }
  OutputEnable enable() const { return enable_; }
  /// Whether the firmware has ever called a chip.
  bool is_used() const { return used_; }

 private:
  void on_message(std::uint32_t value);
  void on_control_written();
  void pace();
  void note_outputs();
  std::uint64_t cycle() const;

  std::vector<Pca9685> chips_;
  std::vector<bool> deaf_;
  std::vector<std::vector<DutyChange>> changes_;
  avr_t* avr_ = nullptr;
  avr_twi_t* twi_ = nullptr;
  std::uint64_t power_on_cycle_ = 0;
  std::uint64_t off_cycle_ = 0;
  OutputEnable enable_ = OutputEnable::kHigh;
  BusFault fault_ = BusFault::kNone;
  int clocks_ = 0;                    ///< that a chip which holds SDA has got
  bool scl_pulled_ = false;           ///< by the microcontroller's pin
  std::size_t addressed_ = SIZE_MAX;  ///< chip that hears the bytes
  bool used_ = false;
  bool starting_ = false;  ///< a start condition is on its way, not a byte
};

}  // namespace vestige::test
