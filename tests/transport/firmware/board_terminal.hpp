#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vestige::test {

/// The board's end of a pseudo terminal, whose other end a client opens as it would a serial port: raw, and there for
/// clients that come, go, or are killed. As on a real line, what a client has not read is lost when it goes, so is what
/// the board says while nobody listens, and a client's lock ends with it; within the time that `wait` is called again.
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
  void open();
  void close();
  void note_clients();

  int board_end_ = -1;
  int client_end_ = -1;  ///< kept open: what a client leaves behind can be undone only there
  int watch_ = -1;       ///< tells of clients that open and close their end
  int clients_ = 0;      ///< as far as one knows: of two that open at the same instant, one is told
  std::string name_;
  std::filesystem::path link_;
};

}  // namespace vestige::test
