#include "tests/transport/firmware/simulated_board.hpp"

#include <avr_ioport.h>
#include <avr_timer.h>
#include <avr_uart.h>
#include <elf.h>
#include <fmt/format.h>
#include <sim_avr.h>
#include <sim_elf.h>
#include <sim_io.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/timeline/timeline_csv.hpp"

namespace vestige::test {

namespace {

// Where the motors hang, in both microcontrollers: three compare outputs of a timer on pins 3, 4, 5 of a port.
constexpr std::size_t kOutputs = 3;
constexpr unsigned kFirstPin = 3;

struct Port {
  char timer;
  std::uint16_t data_direction, port, timer_control_a;  // addresses
};

constexpr std::array<Port, 2> kPorts = {{{'4', 0x101, 0x102, 0xA0}, {'5', 0x10A, 0x10B, 0x120}}};

constexpr std::uint64_t kBitsPerByte = 10;        // a start bit, eight, a stop bit
constexpr std::uint64_t kSimavrBitsPerByte = 11;  // it counts a parity bit that nobody sends

void stay_silent(avr_t*, const int level, const char* format, va_list arguments) {
  if (level < LOG_ERROR) std::vfprintf(stderr, format, arguments);
}

void return_at_once(avr_t*, avr_cycle_count_t) {}

avr_cycle_count_t wake(avr_t*, avr_cycle_count_t, void*) {
  return 0;
}

std::string microcontroller_of(const std::filesystem::path& firmware) {
  std::ifstream file(firmware, std::ios::binary);
  if (!file)
    throw Error(firmware.string(), "there is no such file", "build it: cmake --build build/release --target firmware");
  Elf32_Ehdr header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!file || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 || header.e_machine != EM_AVR) {
    throw Error(firmware.string(), "this is no program for an AVR", "give the firmware's .elf, not its .hex");
  }
  constexpr unsigned kFamilyMask = 0x7F;
  switch (header.e_flags & kFamilyMask) {
    case 51:
      return "atmega1280";
    case 6:
      return "atmega2560";
    default:
      throw Error(firmware.string(), "it does not say which microcontroller it is for", "name it with --mcu");
  }
}

}  // namespace

SimulatedBoard::SimulatedBoard(const std::filesystem::path& firmware, const std::string& microcontroller,
                               const std::uint32_t baud, const std::size_t chips)
    : name_(firmware.string()),
      microcontroller_(microcontroller),
      baud_(baud),
      byte_cycles_((kClock_hz * kBitsPerByte + baud / 2) / baud),
      firmware_(std::make_unique<elf_firmware_t>()),
      chips_(chips) {
  const std::string linked_for = microcontroller_of(firmware);
  if (microcontroller_.empty()) microcontroller_ = linked_for;
  avr_global_logger_set(stay_silent);
  std::memset(firmware_.get(), 0, sizeof *firmware_);
  if (elf_read_firmware(name_.c_str(), firmware_.get()) != 0) {
    throw Error(name_, "the simulator cannot read it", "build it again: cmake --build build/release --target firmware");
  }
  firmware_->frequency = kClock_hz;
  power_on();
}

SimulatedBoard::~SimulatedBoard() {
  power_off();
  std::free(firmware_->flash);
}

void SimulatedBoard::power_on() {
  avr_ = avr_make_mcu_by_name(microcontroller_.c_str());
  if (avr_ == nullptr) {
    throw Error(name_, fmt::format("the simulator does not know the microcontroller '{}'", microcontroller_),
                "use atmega1280 or atmega2560");
  }
  avr_init(avr_);
  avr_load_firmware(avr_, firmware_.get());
  avr_->log = LOG_ERROR;
  avr_->sleep = return_at_once;
  std::uint32_t uart_flags = 0;  // it would print what it receives, and sleep in real time
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &uart_flags);
  for (avr_io_t* io = avr_->io_port; io != nullptr; io = io->next) {
    if (std::strcmp(io->kind, "uart") != 0) continue;
    auto* const uart = reinterpret_cast<avr_uart_t*>(io);
    if (uart->name == '0') uart_ = uart;
  }
  avr_irq_register_notify(avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), byte_from_board, this);
  watch_pins();
  chips_.connect(avr_, power_on_cycle_);
}

void SimulatedBoard::power_off() {
  if (avr_ == nullptr) return;
  avr_terminate(avr_);
  std::free(avr_);
  avr_ = nullptr;
}

void SimulatedBoard::power_cycle() {
  const std::uint64_t now = cycle();
  power_off();
  line_in_.clear();
  compare_output_ = {};
  for (PinDuty& pin : pins_) pin.set(now, false);
  chips_.power_cycle(now);
  power_on_cycle_ = now;
  power_on();
}

void SimulatedBoard::hold_reset(const double duration_s) {
  avr_reset(avr_);
  note_start_pins();
  avr_->cycle += static_cast<std::uint64_t>(duration_s * static_cast<double>(kClock_hz));
}

void SimulatedBoard::derail() {
  // Out of the program's way: RJMP to itself, in the last word of the flash.
  const std::uint32_t address = avr_->flashend - 1;
  avr_->flash[address] = 0xFF;
  avr_->flash[address + 1] = 0xCF;
  avr_->codeend = avr_->flashend;
  avr_->pc = address;
  avr_->sreg[S_I] = 0;
  avr_->state = cpu_Running;
}

void SimulatedBoard::disturb(const std::uint16_t address, const std::uint8_t value) {
  avr_->data[address] = value;
}

void SimulatedBoard::overrun(const std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), byte);
  }
}

void SimulatedBoard::watch_pins() {
  for (std::size_t i = 0; i < kPins; ++i) {
    const Port& port = kPorts[i / kOutputs];
    watches_[i] = {this, i};
    avr_irq_register_notify(avr_io_getirq(avr_, static_cast<std::uint32_t>(AVR_IOCTL_TIMER_GETIRQ(port.timer)),
                                          static_cast<int>(TIMER_IRQ_OUT_COMP + i % kOutputs)),
                            compare_output, &watches_[i]);
  }
  for (std::size_t i = 0; i < kPorts.size(); ++i) {
    for (const std::uint16_t address : {kPorts[i].data_direction, kPorts[i].port, kPorts[i].timer_control_a}) {
      avr_irq_register_notify(avr_iomem_getirq(avr_, address, nullptr, AVR_IOMEM_IRQ_ALL), register_written,
                              &watches_[i * kOutputs]);
    }
  }
}

void SimulatedBoard::update_pins(const std::size_t port) {
  const std::uint8_t* const data = avr_->data;
  for (std::size_t i = 0; i < kOutputs; ++i) {
    const std::size_t motor = port * kOutputs + i;
    const unsigned bit = kFirstPin + static_cast<unsigned>(i);
    const unsigned mode = (data[kPorts[port].timer_control_a] >> (6 - 2 * i)) & 3U;
    const bool output = ((data[kPorts[port].data_direction] >> bit) & 1U) != 0;
    const bool level = mode != 0 ? compare_output_[motor] : ((data[kPorts[port].port] >> bit) & 1U) != 0;
    pins_[motor].set(cycle(), output && level);
  }
}

void SimulatedBoard::compare_output(avr_irq_t*, const std::uint32_t value, void* const watch) {
  const Watch& of = *static_cast<const Watch*>(watch);
  of.board->compare_output_[of.index] = (value & 1U) != 0;
  of.board->update_pins(of.index / kOutputs);
}

void SimulatedBoard::register_written(avr_irq_t*, std::uint32_t, void* const watch) {
  const Watch& of = *static_cast<const Watch*>(watch);
  of.board->update_pins(of.index / kOutputs);
}

void SimulatedBoard::byte_from_board(avr_irq_t*, const std::uint32_t value, void* const board) {
  auto& self = *static_cast<SimulatedBoard*>(board);
  self.match_line_speed();
  if (self.answer_begins_) self.note_answer();
  self.answer_begins_ = value == 0;
  self.line_out_.push_back({self.cycle() + self.byte_cycles_, static_cast<std::uint8_t>(value)});
}

void SimulatedBoard::note_answer() {
  if (frame_end_cycle_ == 0 || frame_end_cycle_ > cycle()) return;
  const double time_s = static_cast<double>(cycle() - frame_end_cycle_) / static_cast<double>(kClock_hz);
  ++answer_times_.count;
  answer_times_.total_s += time_s;
  answer_times_.longest_s = std::max(answer_times_.longest_s, time_s);
  frame_end_cycle_ = 0;
}

// The firmware sets its own speed, of which simavr makes bytes of eleven bits: they take the line's time instead.
void SimulatedBoard::match_line_speed() {
  if (uart_->cycles_per_byte == byte_cycles_ || avr_regbit_get(avr_, uart_->rxen) == 0) return;
  const std::uint64_t own = uart_->cycles_per_byte * kBitsPerByte / kSimavrBitsPerByte;
  constexpr double kTolerance = 0.04;
  if (std::abs(static_cast<double>(own) / static_cast<double>(byte_cycles_) - 1) > kTolerance) wrong_byte_cycles_ = own;
  uart_->cycles_per_byte = byte_cycles_;
}

std::uint64_t SimulatedBoard::feed(avr_t* const avr, const std::uint64_t when, void* const board) {
  auto& self = *static_cast<SimulatedBoard*>(board);
  if (self.line_in_.empty()) return 0;
  self.match_line_speed();
  // simavr itself takes a byte's time to pass it on.
  avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), self.line_in_.front());
  if (self.line_in_.front() == 0) self.frame_end_cycle_ = self.power_on_cycle_ + when + self.byte_cycles_;
  self.line_in_.pop_front();
  self.line_free_cycle_ = self.power_on_cycle_ + when + self.byte_cycles_;
  return when + self.byte_cycles_;
}

void SimulatedBoard::start_feeding() {
  if (line_in_.empty() || avr_cycle_timer_status(avr_, feed, this) != 0) return;
  const std::uint64_t wait = line_free_cycle_ > cycle() ? line_free_cycle_ - cycle() : 1;
  avr_cycle_timer_register(avr_, wait, feed, this);
}

void SimulatedBoard::send(const std::span<const std::uint8_t> bytes) {
  line_in_.insert(line_in_.end(), bytes.begin(), bytes.end());
  start_feeding();
}

std::vector<std::uint8_t> SimulatedBoard::take_received() {
  std::vector<std::uint8_t> bytes;
  for (; !line_out_.empty() && line_out_.front().cycle <= cycle(); line_out_.pop_front()) {
    bytes.push_back(line_out_.front().byte);
  }
  return bytes;
}

std::uint64_t SimulatedBoard::cycle() const {
  return power_on_cycle_ + avr_->cycle;
}

void SimulatedBoard::note_start_pins() {
  compare_output_ = {};
  for (std::size_t i = 0; i < kPorts.size(); ++i) update_pins(i);
  chips_.update();
}

void SimulatedBoard::run_until_cycle(const std::uint64_t end) {
  // A program that sleeps would be carried past the end, to whatever wakes it.
  if (cycle() < end) avr_cycle_timer_register(avr_, end - cycle(), wake, nullptr);
  while (cycle() < end) {
    if (avr_->pc == 0) {  // the program starts: pins are inputs until it says otherwise, and simavr has lost its timers
      ++starts_;
      note_start_pins();
      start_feeding();
    }
    const int state = avr_run(avr_);
    if (state == cpu_Crashed || state == cpu_Done) {
      throw Error(name_, fmt::format("the firmware crashed at {:.6f} s", time_s()), "this is an error in the firmware");
    }
    if (wrong_byte_cycles_ != 0) {
      throw Error(name_,
                  fmt::format("it listens at {} baud, the line has {}",
                              kClock_hz * kBitsPerByte / std::exchange(wrong_byte_cycles_, 0), baud_),
                  "give --baud what the firmware was built with");
    }
  }
  for (PinDuty& pin : pins_) pin.advance(cycle());
}

void SimulatedBoard::run_until_sent() {
  while (!line_in_.empty() || cycle() < line_free_cycle_) run_until_cycle(std::max(cycle() + 1, line_free_cycle_));
}

std::vector<DutyRow> SimulatedBoard::duties() {
  struct Change {
    std::uint64_t cycle;
    std::size_t motor;
    std::uint8_t duty;
  };
  std::vector<Change> changes;
  for (std::size_t motor = 0; motor < motors(); ++motor) {
    const auto& of_motor = chips_.outputs() == 0 ? pins_[motor].changes() : chips_.changes(motor);
    for (const DutyChange& change : of_motor) changes.push_back({change.cycle, motor, change.duty});
  }
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.cycle < b.cycle; });
  std::vector<DutyRow> rows = {{0, std::vector<std::uint8_t>(motors())}};
  std::uint64_t row_cycle = 0;
  for (const Change& change : changes) {
    if (change.cycle != row_cycle) {
      rows.push_back(rows.back());
      rows.back().time_s = static_cast<double>(change.cycle) / static_cast<double>(kClock_hz);
      row_cycle = change.cycle;
    }
    rows.back().duty[change.motor] = change.duty;
  }
  return rows;
}

void SimulatedBoard::write_duties(const std::filesystem::path& path) {
  TimelineCsv file(path, Overwrite::kAllow, motors());
  for (const DutyRow& row : duties()) file.write({row.time_s, {row.duty.begin(), row.duty.end()}});
  file.commit();
}

}  // namespace vestige::test
