#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vestige {

/// Owns a file descriptor, or none (negative). Never closes standard input, output or error.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int value() const { return value_; }
  int release();

 private:
  int value_;
};

/// A file, a pipe, a device or ("-") standard input, read from beginning to end. Throws `Error` with its name if it
/// does not exist, cannot be read, or is a folder. Also throws if a wait for a pipe was stopped (see
/// `stop_waiting_when`).
class InputDescriptor {
 public:
  explicit InputDescriptor(const std::filesystem::path& path);

  /// The name that error messages use.
  const std::string& name() const { return name_; }
  /// Whether it is a regular file, which has a size and random access.
  bool is_regular() const { return is_regular_; }
  /// Whether it is a character device, such as a terminal or /dev/zero.
  bool is_device() const { return is_device_; }
  /// 0 unless `is_regular()`.
  std::uint64_t size_bytes() const { return size_bytes_; }

  /// Reads at least one byte into the front of `out`. Returns the number of bytes, or 0 at the end.
  std::size_t read(std::span<std::byte> out);
  int release() { return descriptor_.release(); }

 private:
  std::string name_;
  Descriptor descriptor_;
  bool is_regular_ = false;
  bool is_device_ = false;
  std::uint64_t size_bytes_ = 0;
};

/// Opens a device or a FIFO for writing. For a FIFO, waits until a reader opens it. Throws `Error`, also if the wait
/// was stopped (see `stop_waiting_when`).
int open_device_for_writing(const std::filesystem::path& path);

/// Sets a function that is called ten times a second while an `InputDescriptor` or a FIFO makes its reader wait. If it
/// returns true, the wait ends with an `Error`. Without such a function, waits are unlimited.
void stop_waiting_when(bool (*is_stopped)());

}  // namespace vestige
