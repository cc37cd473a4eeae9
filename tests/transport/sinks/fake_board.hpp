#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "tests/transport/sinks/pseudo_terminal.hpp"
#include "tests/transport/wire/wire_answers.hpp"

namespace vestige::test {

/// A board at the other end of a pseudo-terminal: answers hello with six actuators, and every other whole frame with an
/// acknowledgement. It checks what it is sent as a board does, and obeys nothing.
class FakeBoard {
 public:
  struct Options {
    std::size_t deaf_to_hellos = 0;  ///< as many it does not answer: it is still in its bootloader
    std::function<Bytes(const Bytes&)> unwrap = [](const Bytes& bytes) { return bytes; };  ///< of all it ever got
    std::function<Bytes(const Bytes&)> wrap = [](const Bytes& bytes) { return bytes; };
  };

  FakeBoard() : FakeBoard(Options()) {}
  explicit FakeBoard(Options options) : options_(std::move(options)), thread_([this] { run(); }) {}
  ~FakeBoard() {
    stop_ = true;
    thread_.join();
  }
  FakeBoard(const FakeBoard&) = delete;
  FakeBoard& operator=(const FakeBoard&) = delete;

  const std::string& path() const { return line_.path(); }

  /// Payloads of the frames that came, without their CRC, in order.
  std::vector<Bytes> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  void run() {
    Bytes line;
    std::size_t answered = 0;
    while (!stop_) {
      const Bytes more = line_.read(2);
      line.insert(line.end(), more.begin(), more.end());
      const std::vector<Bytes> frames = payloads(options_.unwrap(line));
      for (; answered < frames.size(); ++answered) answer(frames[answered]);
    }
  }

  static std::vector<Bytes> payloads(const Bytes& line) {
    std::vector<Bytes> all;
    for (auto from = line.begin(), to = from; (to = std::find(from, line.end(), 0)) != line.end(); from = to + 1) {
      const std::optional<Bytes> payload = cobs_decode(Bytes(from, to));
      if (!payload || payload->size() < 3) continue;
      const Bytes content(payload->begin(), payload->end() - 2);
      if (sealed(content) == Bytes(from, to + 1)) all.push_back(content);
    }
    return all;
  }

  void answer(const Bytes& payload) {
    {
      const std::lock_guard lock(mutex_);
      heard_.push_back(payload);
    }
    const bool is_hello = payload[0] == 'H';
    if (!is_hello)
      line_.write(options_.wrap(acknowledgement(payload[1], 0, 0)));
    else if (++hellos_ > options_.deaf_to_hellos)
      line_.write(options_.wrap(greeting(payload[1], 3, 6, 1)));
  }

  Options options_;
  PseudoTerminal line_;
  std::size_t hellos_ = 0;
  mutable std::mutex mutex_;
  std::vector<Bytes> heard_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace vestige::test
