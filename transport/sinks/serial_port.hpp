#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// 115200 is not the same to all: 111111 to an XBee, 117647 to an AVR at 16 MHz. At 57600 they agree.
inline constexpr std::uint32_t kDefaultBaud = 57600;

/// Of a byte on the line, with its start and stop bit.
inline constexpr double kBitsPerByte = 10;

/// Serial ports of this machine that a vest may hang on, by name. `devices`: the folder with their nodes.
std::vector<std::string> serial_candidates(const std::filesystem::path& devices = "/dev");

/// A serial line: raw bytes, 8 data bits, no parity, one stop bit, no flow control; nobody else has it open. It keeps
/// DTR up when it closes, so that only the first opening resets an Arduino.
class SerialPort {
 public:
  /// Bytes that came before are dropped. `patience`: how long one write may take before the line counts as lost.
  /// Throws `UsageError` for a baud that is none of the standard ones, `Error` where the path is no serial device, may
  /// not be opened, is in use, or its driver refuses the baud.
  SerialPort(const std::string& path, std::uint32_t baud,
             std::chrono::milliseconds patience = std::chrono::milliseconds(500));
  /// Waits for what was written, but not for a line that has stopped.
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Returns when the system has taken all. Throws `LinkLost` when the device is gone or takes nothing any more; a part
  /// may have been sent then.
  void write(std::span<const std::uint8_t> bytes);
  /// What has come, without waiting. Throws `LinkLost`.
  std::vector<std::uint8_t> read();
  /// Whether something can be read, or the line is lost, within that time.
  bool wait_readable(std::chrono::milliseconds longest) const;
  /// Written, and still in the system as far as its driver knows; 0 where it does not.
  std::size_t pending_bytes() const;

  int descriptor() const { return descriptor_; }

 private:
  std::string path_;
  std::chrono::milliseconds patience_;
  int descriptor_;
};

}  // namespace vestige
