#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vestige {

/// Compares when actuators vibrate with when contacts ask them to.
///
/// The truth is the instant of each contact within its frame, and the actuators that the contact asks for under the
/// law. F1 counts frames (Mesaros, Heittola & Virtanen 2016, "Metrics for polyphonic sound event detection",
/// segment-based):
/// - an actuator that vibrates in a frame whose contacts ask for it is right;
/// - an actuator that vibrates without being asked for is a false alarm, so holding an actuator has a cost;
/// - an actuator that is asked for and does not vibrate is missed;
/// - a contact that asks for nothing, such as a contact on skin without an actuator, is missed too.
///
/// The onset error is the time from the first contact to the start of the vibration. The offset error is the time from
/// the last contact to its end. Onset delays beyond 15, 45 and 50 ms are counted, since people notice such delays
/// between seen and felt touch (Di Luca & Mahnan 2019; Vogels 2004).
class TimingScore {
 public:
  explicit TimingScore(std::size_t actuator_count);

  /// A contact in `frame` asks for an actuator.
  void ask(std::size_t actuator, std::uint64_t frame, double instant_s) {
    Asked& asked = asked_[actuator];
    if (asked.frame != frame) {
      asked.frame = frame;
      ++asked_pairs_;
    }
    if (!asked.is_on && !asked.is_pending) {
      asked.is_pending = true;
      asked.since_s = instant_s;
    } else if (asked.is_pending && instant_s < asked.since_s) {
      asked.since_s = instant_s;
    }
    if (instant_s > asked.last_s) asked.last_s = instant_s;
  }
  /// A contact of the frame asks for nothing.
  void ask_nothing() { ++asked_pairs_; }

  /// An actuator vibrates during `frame`.
  void vibrates(std::size_t actuator, std::uint64_t frame) {
    ++on_pairs_;
    if (asked_[actuator].frame == frame) ++right_pairs_;
  }
  /// An actuator begins or ends to vibrate. `begins` counts an onset only if a contact asked for the actuator.
  void begins(std::size_t actuator, double time_s);
  void ends(std::size_t actuator, double time_s);
  /// The contact is over, and the actuator never began to vibrate.
  void gives_up(std::size_t actuator) { asked_[actuator].is_pending = false; }
  bool is_on(std::size_t actuator) const { return asked_[actuator].is_on; }

  double f1() const;                           ///< NaN if nothing was asked for and nothing vibrated
  double mean_onset_s() const;                 ///< NaN if there was no onset
  double mean_offset_s() const;                ///< NaN if no vibration ended
  double late_share(std::size_t limit) const;  ///< share of onsets later than limit number 0, 1, 2: 15, 45, 50 ms
  std::uint64_t onsets() const { return onsets_; }

 private:
  struct Asked {
    std::uint64_t frame = ~std::uint64_t{0};  ///< the last frame that asked for it
    double since_s = 0;
    double last_s = -1e300;
    bool is_pending = false;
    bool is_on = false;
  };
  std::vector<Asked> asked_;
  std::uint64_t asked_pairs_ = 0;
  std::uint64_t on_pairs_ = 0;
  std::uint64_t right_pairs_ = 0;
  std::uint64_t onsets_ = 0;
  std::uint64_t offsets_ = 0;
  double onset_sum_s_ = 0;
  double offset_sum_s_ = 0;
  std::array<std::uint64_t, 3> late_ = {};
};

}  // namespace vestige
