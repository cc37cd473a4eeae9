#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vestige::test {

/// The chips' common pin OE, which is active low.
enum class OutputEnable : std::uint8_t { kLow, kHigh };

/// A PCA9685: registers, and what its outputs do. Source: NXP, PCA9685 data sheet, revision 4, sections 7.3 and 7.4.
/// Outputs that are not driven count as low, as a resistor at each transistor makes them.
class Pca9685 {
 public:
  static constexpr std::size_t kChannels = 16;
  static constexpr unsigned kPeriodCounts = 4096;

  /// The supply has just come: all outputs off, asleep.
  Pca9685();

  /// Its address was called for a write.
  void start();
  /// A byte of that write, at a time that never goes back.
  void write(std::uint8_t byte, double time_s);
  /// A stop condition.
  void stop();

  /// Counts of a period of 4096 in which the channel is high.
  unsigned high_counts(std::size_t channel, OutputEnable enable) const;
  double frequency_hz() const;
  /// What was done that the data sheet forbids, in words; in order.
  const std::vector<std::string>& misuses() const { return misuses_; }

 private:
  void set_register(std::uint8_t address, std::uint8_t value, double time_s);
  void set_mode1(std::uint8_t value, double time_s);
  bool is_asleep() const;

  std::array<std::uint8_t, 256> registers_{};
  std::array<std::uint8_t, 4 * kChannels> shown_{};  ///< the channels' registers, as the outputs have them
  std::uint8_t pointer_ = 0;
  bool pointer_follows_ = false;  ///< the next byte of the write is the register's address
  double awake_s_ = 0;
  std::vector<std::string> misuses_;
};

}  // namespace vestige::test
