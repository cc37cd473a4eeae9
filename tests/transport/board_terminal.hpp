#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige::test {

/// The board's end of a pseudo terminal, whose other end a client opens as it would a serial port: raw, and there for
/// clients that come, go, or are killed. What the board says while nobody listens is lost, as on a real line.
class BoardTerminal {
 public:
  /// With a path, a symbolic link of that name leads to the terminal for as long as this lives; one that is there
  /// already is replaced. Throws `Error`: no terminal is left, or the link cannot be made.
  explicit BoardTerminal(std::filesystem::path link = {});
  ~BoardTerminal();
  BoardTerminal(const BoardTerminal&) = delete;
  BoardTerminal& operator=(const BoardTerminal&) = delete;

  /// "/dev/pts/7".
  const std::string& name() const { return name_; }
  /// Waits until a client has written something, or for that long.
  void wait(std::int64_t at_most_us);
  /// At most `count` bytes that have come by now.
  std::vector<std::uint8_t> read(std::size_t count);
  void write(std::span<const std::uint8_t> bytes);

 private:
  int descriptor_ = -1;
  std::string name_;
  std::filesystem::path link_;
  bool client_ = false;  ///< somebody has the other end open
};

}  // namespace vestige::test
