#include "tests/transport/firmware/pwm_chips.hpp"

#include <avr_extint.h>
#include <avr_ioport.h>
#include <avr_twi.h>
#include <sim_avr.h>
#include <sim_cycle_timers.h>
#include <sim_io.h>

#include <algorithm>
#include <cstring>

namespace vestige::test {

namespace {

constexpr std::uint16_t kDataDirectionD = 0x2A;
constexpr std::uint16_t kPortD = 0x2B;
constexpr std::uint16_t kBitRate = 0xB8;  // TWBR
constexpr std::uint16_t kStatus = 0xB9;   // TWSR, whose last two bits are the prescaler
constexpr std::uint16_t kControl = 0xBC;  // TWCR
constexpr std::uint8_t kControlEnable = 0x04;
constexpr std::uint8_t kControlStop = 0x10;
constexpr std::uint8_t kControlStart = 0x20;
constexpr std::uint8_t kScl = 1U << 0U;
constexpr std::uint8_t kSda = 1U << 1U;
constexpr std::uint8_t kOutputsOff = 1U << 2U;

constexpr unsigned kFirstAddress = 0x40;
constexpr unsigned kTwiBitsPerByte = 9;  // with the acknowledgement
constexpr int kClocksToFree = 3;
constexpr double kClock_hz = 16e6;
constexpr std::uint64_t kNever = std::uint64_t{1} << 40U;

std::uint8_t as_duty(const unsigned counts) {
  return static_cast<std::uint8_t>(std::min((counts + 8) / 16, 255U));
}

}  // namespace

PwmChips::PwmChips(const std::size_t chips)
    : chips_(chips), deaf_(chips), changes_(chips * Pca9685::kChannels, {{0, 0}}) {}

std::uint64_t PwmChips::cycle() const {
  return avr_ == nullptr ? off_cycle_ : power_on_cycle_ + avr_->cycle;
}

void PwmChips::connect(avr_t* const avr, const std::uint64_t power_on_cycle) {
  avr_ = avr;
  power_on_cycle_ = power_on_cycle;
  for (avr_io_t* io = avr_->io_port; io != nullptr; io = io->next)
    if (std::strcmp(io->kind, "twi") == 0) twi_ = reinterpret_cast<avr_twi_t*>(io);
  avr_irq_register_notify(
      avr_io_getirq(avr_, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_OUTPUT),
      [](avr_irq_t*, const std::uint32_t value, void* const chips) {
        static_cast<PwmChips*>(chips)->on_message(value);
      },
      this);
  avr_irq_register_notify(
      avr_iomem_getirq(avr_, kControl, nullptr, AVR_IOMEM_IRQ_ALL),
      [](avr_irq_t*, std::uint32_t, void* const chips) { static_cast<PwmChips*>(chips)->on_control_written(); }, this);
  for (const std::uint16_t address : {kDataDirectionD, kPortD})
    avr_irq_register_notify(
        avr_iomem_getirq(avr_, address, nullptr, AVR_IOMEM_IRQ_ALL),
        [](avr_irq_t*, std::uint32_t, void* const chips) { static_cast<PwmChips*>(chips)->update(); }, this);
  // simavr would look at a low pin of an external interrupt (OE's is INT2) anew in every cycle, which takes most of its
  // time. The firmware uses none of these interrupts.
  for (std::uint8_t interrupt = 0; interrupt < 3; ++interrupt) avr_extint_set_strict_lvl_trig(avr_, interrupt, 0);
  update();
}

void PwmChips::power_cycle(const std::uint64_t cycle) {
  off_cycle_ = cycle;
  avr_ = nullptr;
  std::ranges::fill(chips_, Pca9685());
  enable_ = OutputEnable::kHigh;
  note_outputs();
}

void PwmChips::update() {
  const std::uint8_t outputs = avr_->data[kDataDirectionD];
  const std::uint8_t port = avr_->data[kPortD];
  const bool pulled = (outputs & ~port & kScl) != 0;
  if (scl_pulled_ && !pulled && fault_ == BusFault::kSdaLowUntilClocks && ++clocks_ == kClocksToFree)
    fault_ = BusFault::kNone;
  scl_pulled_ = pulled;
  std::uint8_t lines = kScl | kSda;
  if (fault_ == BusFault::kSclLow) lines = kSda;
  if (fault_ == BusFault::kSdaLow || fault_ == BusFault::kSdaLowUntilClocks) lines = kScl;
  avr_ioport_external_t pulls{};
  pulls.name = 'D';
  pulls.mask = kScl | kSda;
  pulls.value = lines;
  avr_ioctl(avr_, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &pulls);
  for (int pin = 0; pin < 2; ++pin)
    if ((outputs >> pin & 1) == 0)
      avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('D'), pin), lines >> pin & 1U);
  enable_ = (outputs & kOutputsOff) == 0 || (port & kOutputsOff) != 0 ? OutputEnable::kHigh : OutputEnable::kLow;
  note_outputs();
}

void PwmChips::set_fault(const BusFault fault) {
  fault_ = fault;
  clocks_ = 0;
  update();
  pace();
}

void PwmChips::on_message(const std::uint32_t value) {
  avr_twi_msg_irq_t message{};
  message.u.v = value;
  const auto acknowledge = [&] {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_INPUT),
                  avr_twi_irq_msg(TWI_COND_ACK, message.u.twi.addr, 1));
  };
  const unsigned kind = message.u.twi.msg;
  if ((kind & TWI_COND_STOP) != 0) {
    if (fault_ != BusFault::kNone) return;
    for (Pca9685& chip : chips_) chip.stop();
    addressed_ = SIZE_MAX;
    note_outputs();
  } else if ((kind & TWI_COND_START) != 0) {
    used_ = true;
    const std::size_t chip = (message.u.twi.addr >> 1U) - kFirstAddress;
    addressed_ = chip < chips_.size() && !deaf_[chip] ? chip : SIZE_MAX;
    if (addressed_ == SIZE_MAX) return;
    chips_[chip].start();
    acknowledge();
  } else if ((kind & TWI_COND_WRITE) != 0 && addressed_ != SIZE_MAX) {
    chips_[addressed_].write(message.u.twi.data, static_cast<double>(cycle()) / kClock_hz);
    note_outputs();
    acknowledge();
  }
}

/// simavr has done by now what the write asks for.
void PwmChips::on_control_written() {
  const std::uint8_t control = avr_->data[kControl];
  starting_ = (control & kControlStart) != 0;
  // simavr keeps the bit that asks for a stop condition. A real one keeps it until the condition has come about.
  if (fault_ == BusFault::kNone) avr_->data[kControl] &= static_cast<std::uint8_t>(~kControlStop);
  pace();
}

/// Gives what is on its way on the bus its real time.
void PwmChips::pace() {
  const avr_cycle_timer_slot_t* slot = avr_->cycle_timers.timer;
  while (slot != nullptr && slot->param != twi_) slot = slot->next;
  if (slot == nullptr) return;
  const avr_cycle_timer_t timer = slot->timer;
  avr_cycle_timer_cancel(avr_, timer, twi_);
  if ((avr_->data[kControl] & kControlEnable) == 0) return;  // simavr would go on
  const std::uint64_t bit_cycles = 16 + (2U * avr_->data[kBitRate] << 2U * (avr_->data[kStatus] & 3U));
  const std::uint64_t cycles = bit_cycles * (starting_ ? 1 : kTwiBitsPerByte);
  avr_cycle_timer_register(avr_, fault_ == BusFault::kNone ? cycles : kNever, timer, twi_);
}

unsigned PwmChips::high_counts(const std::size_t output) const {
  return chips_[output / Pca9685::kChannels].high_counts(output % Pca9685::kChannels, enable_);
}

void PwmChips::note_outputs() {
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const std::uint8_t duty = as_duty(high_counts(i));
    if (duty != changes_[i].back().duty) changes_[i].push_back({cycle(), duty});
  }
}

}  // namespace vestige::test
