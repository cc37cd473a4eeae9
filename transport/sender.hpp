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
  std::chrono::microseconds floor = std::chrono::milliseconds(5);     ///< least time between two frames
  std::chrono::microseconds refresh = std::chrono::milliseconds(20);  ///< an unchanged state is sent again after this
  /// If neither `post` nor `still_here` is called for this time, states are no longer refreshed.
  std::chrono::milliseconds deserted = std::chrono::seconds(1);
  bool keep_log = false;  ///< for `take_log`
};

/// The fate of a changed state.
struct SentState {
  enum class Fate : std::uint8_t {
    kSent,
    kSuperseded,  ///< a newer state, or the final switching off, replaced it before it was sent
  };
  ActuatorFrame frame;
  Fate fate = Fate::kSent;
  double written_s = 0;  ///< from `since` until its last byte was written
};

/// What a sender has done. Of several senders together: sums, the largest number unanswered, and whether all are off.
struct SenderStatistics {
  std::uint64_t sent = 0;     ///< frames passed to the system: changes, refreshes and the final frames that switch off
  std::uint64_t changes = 0;  ///< frames with a changed state
  std::uint64_t superseded = 0;  ///< changes that were never sent
  std::uint64_t acknowledged = 0;
  std::uint64_t fail_safes = 0;       ///< answers saying that the board had switched itself off, less output_failures
  std::uint64_t output_failures = 0;  ///< answers saying that the board's output chips had not answered it
  std::uint64_t overruns = 0;         ///< answers saying that the board had lost bytes
  std::uint64_t receive_errors = 0;   ///< damaged frames, by the board's count
  std::uint64_t links_lost = 0;       ///< number of times that the link was lost
  std::uint64_t bytes = 0;            ///< passed to the system
  /// Most frames under way at once while states are sent: it stays small, as there is no queue. 0: no answers. The two
  /// frames that switch off go out together and do not count.
  std::uint64_t most_unanswered = 0;
  LatencyHistogram written;             ///< of changes: from `since` until the last byte was written
  LatencyHistogram acknowledged_after;  ///< of changes: from `since` until their answer
  bool off_sent = false;
  bool off_acknowledged = false;    ///< the board acknowledged the frame OFF; false if it never answers
  bool zeros_acknowledged = false;  ///< it acknowledged the state before OFF, in which all levels are 0

  SenderStatistics& operator+=(const SenderStatistics& other);
};

/// Sends states to a sink from its own thread, at the sink's pace. States go through a mailbox of one slot, in which
/// the latest wins. So no queue builds up, and the vest never gets an old state. A changed state leaves at once, but
/// not within `floor` after the frame before. An unchanged state is refreshed, so that the board's fail-safe does not
/// trigger.
class Sender {
 public:
  using Clock = std::chrono::steady_clock;

  /// Calls `on_event`, in the sender's thread, when the link is lost and when it is back.
  Sender(ActuatorSink& sink, const SenderOptions& options, std::function<void(const std::string&)> on_event);
  /// Does the same as `finish`, but ignores errors.
  ~Sender();
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Posts a state to be sent, unless it equals the one before. Latencies count from `since`. Throws the exception of
  /// the sink, if it threw one.
  void post(const ActuatorFrame& frame, Clock::time_point since);

  /// Whether the state posted last was acknowledged, or was sent, if the sink never acknowledges.
  bool heard() const { return heard_ == posted_; }

  /// Tells the sender that the posting program is alive. If neither this nor `post` is called for `deserted`, the
  /// sender refreshes nothing and switches the actuators off. A board's ttl would also switch it off.
  void still_here() { alive_ = Clock::now().time_since_epoch().count(); }

  /// With `keep_log`: returns the fates of states, in order, as far as they are known and were not returned before.
  std::vector<SentState> take_log();

  /// Begins what `finish` does, and returns at once.
  void stop();

  /// Sends the last state and waits at most 0.25 s for its answer. Then switches everything off: by a state with all
  /// levels 0, which every board understands, and by OFF. Waits at most 1 s for the answer to OFF (0.25 s if nothing
  /// was ever answered). If no answer comes, does this once more. Throws the exception of the sink, if it threw one.
  SenderStatistics finish();

 private:
  struct Posted {
    ActuatorFrame frame;
    Clock::time_point since;
    std::uint64_t number = 0;  ///< number of the state, from 1
  };
  /// A change that is being written.
  struct InFlight {
    Posted posted;
    std::size_t place = 0;  ///< index in the log
  };
  struct Outstanding {
    bool waiting = false;
    bool changed = false;
    Clock::time_point since;
    std::uint64_t number = 0;  ///< number of the state that the frame carried; 0: none, or off
  };

  /// The sequences of the frames that switch everything off.
  struct OffFrames {
    std::optional<std::uint8_t> zeros;  ///< nothing if no state was sent before
    std::uint8_t off = 0;
  };

  /// Removes a state from the mailbox that will not be sent.
  void supersede();
  void run();
  void loop();
  void switch_off();
  OffFrames send_all_off();
  /// Waits until a state is posted, an answer arrives, or the time `until`.
  void wait(Clock::time_point until);
  bool has_changed();
  void look_for_life(Clock::time_point now);
  bool may_send(Clock::time_point now);
  Clock::time_point next_chance(Clock::time_point now);
  void send_state();
  /// Takes the state out of the mailbox. Returns null if the mailbox is empty.
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
  std::atomic<std::uint64_t> posted_ = 0;  ///< number of states posted
  std::atomic<std::uint64_t> heard_ = 0;   ///< number of the newest state known to have arrived
  std::atomic<bool> stopping_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;

  // Used by the posting thread.
  std::optional<std::vector<std::uint8_t>> posted_before_;
  // Used by the sender's thread.
  ActuatorFrame state_;
  std::uint64_t state_number_ = 0;
  bool has_state_ = false;
  bool linked_ = true;
  bool deserted_ = false;  ///< neither `post` nor `still_here` was called for `SenderOptions::deserted`
  Clock::time_point last_sent_;
  Clock::time_point next_try_;
  std::uint8_t sequence_ = 0;
  std::array<Outstanding, 256> outstanding_;
  std::uint8_t answered_ = 0;  ///< sequence of the newest answer
  std::optional<std::uint8_t> receive_errors_before_;
  SenderStatistics statistics_;

  std::thread thread_;  // declared last, because it uses all other members
};

}  // namespace vestige
