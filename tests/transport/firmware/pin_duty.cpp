#include "tests/transport/firmware/pin_duty.hpp"

namespace vestige::test {

namespace {

// An interrupt may hold the simulated timer up by an instruction or two.
constexpr std::uint64_t kSlack_cycles = 16;

bool is_one_period(std::uint64_t cycles) {
  return cycles + kSlack_cycles >= PinDuty::kPeriod_cycles && cycles <= PinDuty::kPeriod_cycles + kSlack_cycles;
}

}  // namespace

void PinDuty::note(std::uint64_t cycle, std::uint8_t duty) {
  if (duty != changes_.back().duty) changes_.push_back({cycle, duty});
}

void PinDuty::advance(std::uint64_t cycle) {
  if (cycle > last_edge_ + kPeriod_cycles + kSlack_cycles) note(last_edge_, high_ ? 255 : 0);
}

void PinDuty::set(std::uint64_t cycle, bool high) {
  if (high == high_) return;
  advance(cycle);
  if (high) {
    if (last_rise_ > 0 && is_one_period(cycle - last_rise_)) {
      note(last_rise_, static_cast<std::uint8_t>((pulse_ * 256 + kPeriod_cycles / 2) / kPeriod_cycles));
    }
    last_rise_ = cycle;
  } else {
    pulse_ = cycle - last_edge_;
    high_cycles_ += pulse_;
  }
  high_ = high;
  last_edge_ = cycle;
}

std::uint64_t PinDuty::high_cycles(std::uint64_t now) const {
  return high_cycles_ + (high_ ? now - last_edge_ : 0);
}

}  // namespace vestige::test
