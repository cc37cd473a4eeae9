#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vestige {

/// Owns a file descriptor, or none (negative); never closes the standard three.
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

/// A file, a pipe, a device or ("-") standard input, read from its beginning to its end. Throws `Error` naming it:
/// missing, unreadable, a folder, stopped while it waited for a pipe (see `stop_waiting_when`).
class InputDescriptor {
 public:
  explicit InputDescriptor(const std::filesystem::path& path);

  /// What errors are to name.
  const std::string& name() const { return name_; }
  /// Whether it has a size and can be read anywhere.
  bool is_regular() const { return is_regular_; }
  /// Whether it is a character device, such as a terminal or /dev/zero.
  bool is_device() const { return is_device_; }
  /// 0 unless `is_regular()`.
  std::uint64_t size_bytes() const { return size_bytes_; }

  /// Fills a part of `out` that is not empty; returns how much, 0 at the end.
  std::size_t read(std::span<std::byte> out);
  int release() { return descriptor_.release(); }

 private:
  std::string name_;
  Descriptor descriptor_;
  bool is_regular_ = false;
  bool is_device_ = false;
  std::uint64_t size_bytes_ = 0;
};

/// Opens a device or a FIFO for writing; a FIFO when its reader comes. Throws `Error`, also when stopped meanwhile.
int open_device_for_writing(const std::filesystem::path& path);

/// What is asked ten times a second while an `InputDescriptor` or a FIFO makes its reader wait: true ends the wait with
/// an error. Until this is called, waits last.
void stop_waiting_when(bool (*is_stopped)());

}  // namespace vestige
