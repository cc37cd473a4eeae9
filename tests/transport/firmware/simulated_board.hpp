#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tests/transport/firmware/pin_duty.hpp"
#include "tests/transport/firmware/pwm_chips.hpp"

struct avr_t;
struct avr_uart_t;
struct avr_irq_t;
struct elf_firmware_t;

// simavr is under the GPL, version 3. So this board is a test program's, and nothing of `vestige` links it.
namespace vestige::test {

/// Duties of all motors from then on.
struct DutyRow {
  double time_s = 0;
  std::vector<std::uint8_t> duty;
};

/// The vest's firmware on a simulated microcontroller of 16 MHz, in virtual time: the same input, the same output.
///
/// Its motors hang on six pins, or on PCA9685 chips.
///
/// A motor's pin follows its timer's compare output while that is connected, and its port otherwise, as the data sheet
/// draws it; simavr's own pins fall back to the port's bit whenever the port is written.
class SimulatedBoard {
 public:
  static constexpr std::size_t kPins = 6;
  static constexpr std::uint64_t kClock_hz = 16'000'000;

  /// `microcontroller` as simavr calls it, "atmega1280"; empty: the kind that the ELF was linked for, as far as it says
  /// so. `baud` is the line's; the firmware must be within 4 % of it, as a real line demands. `chips` is the number of
  /// PCA9685 that drive the motors; 0: pins do. Throws `Error`: the file cannot be read, is no AVR program, or the
  /// simulator does not know the microcontroller.
  explicit SimulatedBoard(const std::filesystem::path& firmware, const std::string& microcontroller = "",
                          std::uint32_t baud = 57600, std::size_t chips = 0);
  ~SimulatedBoard();
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;

  /// Since the board was made, power cycles included.
  std::uint64_t cycle() const;
  double time_s() const { return static_cast<double>(cycle()) / static_cast<double>(kClock_hz); }

  /// Throws `Error` when the program has crashed, or listens at another speed than the line's.
  void run_until_cycle(std::uint64_t cycle);
  void run_until(double time_s) {
    run_until_cycle(static_cast<std::uint64_t>(time_s * static_cast<double>(kClock_hz)));
  }
  void run_for(double duration_s) { run_until(time_s() + duration_s); }
  /// Until everything sent has arrived.
  void run_until_sent();

  /// Bytes that follow what is still waiting, at the line's speed, from now on.
  void send(std::span<const std::uint8_t> bytes);
  std::size_t waiting() const { return line_in_.size(); }
  /// What the board has sent, each byte when it has left the board whole.
  std::vector<std::uint8_t> take_received();

  /// The supply fails, all pins go low, and it comes back at once.
  void power_cycle();
  /// RESET is held low for that long: pins are inputs, and chips keep what they have.
  void hold_reset(double duration_s);
  /// The program goes astray: from now on it runs in circles, with interrupts off.
  void derail();
  /// A register changes its value by itself, as in a strong disturbance. `address` as in the data sheet.
  void disturb(std::uint16_t address, std::uint8_t value);
  /// Bytes that all come at once, faster than any receiver takes them: most are lost.
  void overrun(std::span<const std::uint8_t> bytes);
  /// How often the program has started: 1 after the first step, one more after each power cycle and watchdog restart.
  unsigned starts() const { return starts_; }

  /// The firmware's own share of the time: from a frame's last byte, when it has arrived, to the answer's first.
  struct AnswerTimes {
    std::uint64_t count = 0;
    double total_s = 0;
    double longest_s = 0;
  };
  const AnswerTimes& answer_times() const { return answer_times_; }

  std::size_t motors() const { return chips_.outputs() == 0 ? kPins : chips_.outputs(); }
  const PinDuty& pin(std::size_t motor) const { return pins_[motor]; }
  PwmChips& chips() { return chips_; }
  /// The motors' duties so far, a row at each change; the first at 0 s.
  std::vector<DutyRow> duties();
  /// The same in the form of a timeline: `time_s,actuator_1,…`. Overwrites. Throws `Error`.
  void write_duties(const std::filesystem::path& path);

 private:
  struct Watch {
    SimulatedBoard* board = nullptr;
    std::size_t index = 0;
  };
  struct SentByte {
    std::uint64_t cycle = 0;
    std::uint8_t byte = 0;
  };

  void power_on();
  void power_off();
  void watch_pins();
  void note_start_pins();
  void note_answer();
  void match_line_speed();
  void update_pins(std::size_t port);
  void start_feeding();
  static std::uint64_t feed(avr_t* avr, std::uint64_t when, void* board);
  static void compare_output(avr_irq_t* irq, std::uint32_t value, void* watch);
  static void register_written(avr_irq_t* irq, std::uint32_t value, void* watch);
  static void byte_from_board(avr_irq_t* irq, std::uint32_t value, void* board);

  std::string name_;
  std::string microcontroller_;
  std::uint32_t baud_;
  std::uint64_t byte_cycles_;
  std::unique_ptr<elf_firmware_t> firmware_;
  avr_t* avr_ = nullptr;
  avr_uart_t* uart_ = nullptr;
  std::uint64_t power_on_cycle_ = 0;
  std::uint64_t line_free_cycle_ = 0;
  std::uint64_t wrong_byte_cycles_ = 0;  ///< the firmware's own, when it listens at another speed
  unsigned starts_ = 0;
  std::uint64_t frame_end_cycle_ = 0;  ///< 0: it has been answered
  bool answer_begins_ = true;
  AnswerTimes answer_times_;
  std::deque<std::uint8_t> line_in_;
  std::deque<SentByte> line_out_;
  std::array<bool, kPins> compare_output_{};
  std::array<Watch, kPins> watches_{};
  std::array<PinDuty, kPins> pins_;
  PwmChips chips_;
};

}  // namespace vestige::test
