#include "tests/transport/firmware/pca9685.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vestige::test {

namespace {

constexpr std::uint8_t kMode1 = 0x00;
constexpr std::uint8_t kMode2 = 0x01;
constexpr std::uint8_t kFirstChannel = 0x06;
constexpr std::uint8_t kLastChannel = 0x45;  // its last register
constexpr std::uint8_t kAllChannels = 0xFA;
constexpr std::uint8_t kPrescale = 0xFE;

constexpr std::uint8_t kAutoIncrement = 0x20;
constexpr std::uint8_t kSleep = 0x10;
constexpr std::uint8_t kInverted = 0x10;
constexpr std::uint8_t kChangeOnAcknowledge = 0x08;
constexpr std::uint8_t kTotemPole = 0x04;
constexpr std::uint8_t kFull = 0x10;

constexpr double kOscillator_hz = 25e6;
constexpr double kOscillatorStarts_s = 500e-6;

}  // namespace

Pca9685::Pca9685() {
  registers_[kMode1] = kSleep | 0x01;
  registers_[kMode2] = kTotemPole;
  registers_[kPrescale] = 0x1E;
  for (std::size_t i = 0; i < kChannels; ++i) shown_[4 * i + 3] = kFull;
  std::ranges::copy(shown_, registers_.begin() + kFirstChannel);
}

bool Pca9685::is_asleep() const {
  return (registers_[kMode1] & kSleep) != 0;
}

double Pca9685::frequency_hz() const {
  return kOscillator_hz / kPeriodCounts / (registers_[kPrescale] + 1);
}

void Pca9685::start() {
  pointer_follows_ = true;
}

void Pca9685::write(const std::uint8_t byte, const double time_s) {
  if (pointer_follows_) {
    pointer_ = byte;
    pointer_follows_ = false;
    return;
  }
  set_register(pointer_, byte, time_s);
  if ((registers_[kMode1] & kAutoIncrement) != 0) {
    pointer_ = pointer_ == kLastChannel ? kMode1 : static_cast<std::uint8_t>(pointer_ + 1);
  }
  if ((registers_[kMode2] & kChangeOnAcknowledge) != 0) stop();
}

void Pca9685::stop() {
  std::copy_n(registers_.begin() + kFirstChannel, shown_.size(), shown_.begin());
}

void Pca9685::set_mode1(const std::uint8_t value, const double time_s) {
  if (is_asleep() && (value & kSleep) == 0) awake_s_ = time_s;
  registers_[kMode1] = value;
}

void Pca9685::set_register(const std::uint8_t address, const std::uint8_t value, const double time_s) {
  const bool is_channel =
      (address >= kFirstChannel && address <= kLastChannel) || (address >= kAllChannels && address < kAllChannels + 4);
  if (is_channel && !is_asleep() && awake_s_ > 0 && time_s < awake_s_ + kOscillatorStarts_s) {
    misuses_.push_back(fmt::format("register {:#04x} was written {:.0f} us after the oscillator was started", address,
                                   (time_s - awake_s_) * 1e6));
  }
  if (address == kMode1) {
    set_mode1(value, time_s);
  } else if (address == kPrescale && !is_asleep()) {
    misuses_.push_back("the frequency was set while the chip was awake, which ignores it");
  } else if (is_channel && address >= kAllChannels) {
    for (std::size_t i = 0; i < kChannels; ++i) {
      registers_[kFirstChannel + 4 * i + (address - kAllChannels)] = value;
    }
  } else {
    registers_[address] = value;
  }
}

unsigned Pca9685::high_counts(const std::size_t channel, const OutputEnable enable) const {
  const bool totem_pole = (registers_[kMode2] & kTotemPole) != 0;
  if (!totem_pole) return 0;
  if (enable == OutputEnable::kHigh) return (registers_[kMode2] & 3U) == 1 ? kPeriodCounts : 0;
  if (is_asleep()) return 0;
  const std::uint8_t* const of = &shown_[4 * channel];
  unsigned counts = 0;
  if ((of[3] & kFull) == 0) {
    const unsigned on = of[0] | (of[1] & 0x0FU) << 8U;
    const unsigned off = of[2] | (of[3] & 0x0FU) << 8U;
    counts = (of[1] & kFull) != 0 ? kPeriodCounts : (off + kPeriodCounts - on) % kPeriodCounts;
  }
  return (registers_[kMode2] & kInverted) != 0 ? kPeriodCounts - counts : counts;
}

}  // namespace vestige::test
