#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// 57600 baud, because devices differ at 115200: an XBee runs at 111111, an AVR at 16 MHz at 117647. At 57600 both
/// agree.
inline constexpr std::uint32_t kDefaultBaud = 57600;

/// Bits of a byte on the line, including start and stop bit.
inline constexpr double kBitsPerByte = 10;

/// Returns this machine's serial ports that a vest may be connected to, sorted by name. `devices` is the folder of
/// their device nodes.
std::vector<std::string> serial_candidates(const std::filesystem::path& devices = "/dev");

/// A serial line: raw bytes, 8 data bits, no parity, one stop bit, no flow control, opened exclusively. Closing keeps
/// DTR high, so that only the first opening resets an Arduino.
class SerialPort {
 public:
  /// Opens the port and drops bytes received before. `patience` is the longest time for one write; after it the line
  /// counts as lost. Throws `UsageError` if the baud is not a standard one. Throws `Error` if the path is not a serial
  /// device, may not be opened, is in use, or its driver refuses the baud.
  SerialPort(const std::string& path, std::uint32_t baud,
             std::chrono::milliseconds patience = std::chrono::milliseconds(500));
  /// Waits for written bytes to leave, at most `patience`, and drops the rest.
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Returns after the system has taken all bytes. Throws `LinkLost` if the device is gone or accepts no more bytes;
  /// some bytes may have been sent then.
  void write(std::span<const std::uint8_t> bytes);
  /// Returns the bytes received, without waiting. Throws `LinkLost`.
  std::vector<std::uint8_t> read();
  /// Waits at most `longest`. Returns whether bytes can be read or the line is lost.
  bool wait_readable(std::chrono::milliseconds longest) const;
  /// Number of written bytes that are still in the system, as far as the driver knows; otherwise 0.
  std::size_t pending_bytes() const;

  int descriptor() const { return descriptor_; }

 private:
  std::string path_;
  std::chrono::milliseconds patience_;
  int descriptor_;
};

}  // namespace vestige
