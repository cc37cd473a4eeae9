#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "transport/actuator_sink.hpp"
#include "transport/latency_histogram.hpp"

namespace vestige {

struct SenderOptions {
  std::chrono::microseconds floor = std::chrono::milliseconds(5);     ///< between two frames, at least
  std::chrono::microseconds refresh = std::chrono::milliseconds(20);  ///< an unchanged state is sent again after this
  /// When neither `post` nor `still_here` has been called for so long, nothing is refreshed any more.
  std::chrono::milliseconds deserted = std::chrono::seconds(1);
  bool keep_log = false;  ///< for `take_log`
};

/// What became of a changed state.
struct SentState {
  enum class Fate : std::uint8_t {
    kSent,
    kSuperseded,  ///< a newer one, or the off at the end, took its place before it could be sent
  };
  ActuatorFrame frame;
  Fate fate = Fate::kSent;
  double written_s = 0;  ///< from `since` to its last byte written
};

struct SenderStatistics {
  std::uint64_t sent = 0;        ///< frames handed to the system: changes, refreshes and the last, which switches off
  std::uint64_t changes = 0;     ///< those of them that said something new
  std::uint64_t superseded = 0;  ///< changes that were never sent
  std::uint64_t acknowledged = 0;
  std::uint64_t fail_safes = 0;      ///< answers that the board had switched itself off before
  std::uint64_t overruns = 0;        ///< answers that the board had lost bytes
  std::uint64_t receive_errors = 0;  ///< damaged frames, as the board counted them
  std::uint64_t links_lost = 0;      ///< times that the other end had gone
  std::uint64_t bytes = 0;           ///< handed to the system
  std::uint64_t most_unanswered =
      0;  ///< frames that were on their way at a time: there is no queue, so it never grows; 0: no answers
  LatencyHistogram written;             ///< of changes: from `since` to the last byte written
  LatencyHistogram acknowledged_after;  ///< of changes: from `since` to their answer
  bool off_sent = false;
  bool off_acknowledged = false;  ///< the board answered that all is off; false where none ever answers
};

/// Sends states to a sink from a thread of its own, at the sink's pace: a mailbox of one slot, in which the latest
/// wins, so that no queue builds up and what the vest is told is never old. A changed state leaves at once, but not
/// within the floor after the one before; an unchanged one is refreshed, so that the board's fail-safe sleeps.
class Sender {
 public:
  using Clock = std::chrono::steady_clock;

  /// `on_event` is told, in the sender's thread, when the link is lost and when it is back.
  Sender(ActuatorSink& sink, const SenderOptions& options, std::function<void(const std::string&)> on_event);
  /// As `finish`, without its errors.
  ~Sender();
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Leaves a state to be sent, unless it says what the one before said. `since`: from when latencies count. Throws
  /// what the sink threw.
  void post(const ActuatorFrame& frame, Clock::time_point since);

  /// Whether the state that was left last has been acknowledged; where the sink never acknowledges, whether it was
  /// sent.
  bool heard() const { return heard_ == posted_; }

  /// Says that whoever leaves states is alive. When neither this nor `post` has been called for `deserted`, nothing is
  /// refreshed any more, so that the board's ttl switches it off; what has no ttl is switched off.
  void still_here() { alive_ = Clock::now().time_since_epoch().count(); }

  /// With `keep_log`: what became of states, in their order, as far as it is known and was not told before.
  std::vector<SentState> take_log();

  /// Sends the last state, waits 0.25 s at most for its answer, switches everything off and waits for that one's
  /// answer, 1 s at most (0.25 s where nothing was ever answered) and then once more. Throws what the sink threw.
  SenderStatistics finish();

 private:
  struct Posted {
    ActuatorFrame frame;
    Clock::time_point since;
    std::uint64_t number = 0;  ///< counts states from 1
  };
  /// A change that is being written.
  struct InFlight {
    Posted posted;
    std::size_t place = 0;  ///< in the log
  };
  struct Outstanding {
    bool waiting = false;
    bool changed = false;
    Clock::time_point since;
    std::uint64_t number = 0;  ///< of the state that it carried; 0: none, or off
  };

  /// Empties the mailbox of what will not be sent.
  void supersede();
  void run();
  void loop();
  void switch_off();
  /// Waits until something is posted, an answer has come, or `until`.
  void wait(Clock::time_point until);
  bool has_changed();
  void look_for_life(Clock::time_point now);
  bool may_send(Clock::time_point now);
  Clock::time_point next_chance(Clock::time_point now);
  void send_state();
  /// Takes what is in the mailbox; null: nothing.
  const Posted* take_posted();
  void note_written();
  void give_back();
  std::uint8_t next_sequence(const Posted* changed);
  void note_sent();
  void wait_for_last_answer(Clock::duration patience);
  void receive();
  void count_faults(const Acknowledgement& answer);
  void lose_link(const LinkLost& lost);
  void try_reconnecting();
  void wake();

  ActuatorSink& sink_;
  SenderOptions options_;
  std::function<void(const std::string&)> on_event_;
  int wake_descriptor_;

  std::mutex mutex_;
  std::optional<Posted> mailbox_;
  std::optional<InFlight> in_flight_;
  std::vector<SentState> log_;
  std::uint64_t superseded_ = 0;
  std::atomic<Clock::rep> alive_ = Clock::now().time_since_epoch().count();
  std::atomic<std::uint64_t> posted_ = 0;  ///< how many states
  std::atomic<std::uint64_t> heard_ = 0;   ///< the newest that is known to have arrived
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;

  // The posting thread's.
  std::optional<std::vector<std::uint8_t>> posted_before_;
  // The sender thread's.
  ActuatorFrame state_;
  std::uint64_t state_number_ = 0;
  bool has_state_ = false;
  bool linked_ = true;
  bool deserted_ = false;  ///< nobody has been there for a second
  Clock::time_point last_sent_;
  Clock::time_point next_try_;
  std::uint8_t sequence_ = 0;
  std::array<Outstanding, 256> outstanding_;
  std::uint8_t answered_ = 0;  ///< the newest
  std::optional<std::uint8_t> receive_errors_before_;
  SenderStatistics statistics_;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace vestige
