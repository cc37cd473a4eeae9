#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vestige {

/// When actuators vibrate, against when contacts ask them to.
///
/// The truth is the contacts' own instants, within their frames, and which actuators a contact asks for under the law.
/// F1 counts frames (Mesaros, Heittola & Virtanen 2016, "Metrics for polyphonic sound event detection", segment-based):
/// an actuator that is asked for by contacts of a frame and vibrates is right; one that vibrates unasked is a false
/// alarm, so a hold has its price; one that is asked for and does not, and a contact that asks for nothing, such as one
/// on skin without an actuator, are missed.
///
/// The onset error is how long after the first contact an actuator begins to vibrate, the offset error how long after
/// the last one it ends. Delays beyond 15, 45 and 50 ms are counted: what people notice between touch seen and felt
/// (Di Luca & Mahnan 2019; Vogels 2004).
class TimingScore {
 public:
  explicit TimingScore(std::size_t actuator_count);

  /// A contact of frame `frame` asks for an actuator.
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
  /// An actuator begins or ends to vibrate.
  void begins(std::size_t actuator, double time_s);
  void ends(std::size_t actuator, double time_s);
  /// What was asked is over, and it never began.
  void gives_up(std::size_t actuator) { asked_[actuator].is_pending = false; }
  bool is_on(std::size_t actuator) const { return asked_[actuator].is_on; }

  double f1() const;                               ///< NaN where nothing was asked and nothing vibrated
  double mean_onset_s() const;                     ///< NaN where nothing began
  double mean_offset_s() const;                    ///< NaN where nothing ended
  double late_share(std::size_t threshold) const;  ///< of onsets: over 15, 45, 50 ms for 0, 1, 2
  std::uint64_t onsets() const { return onsets_; }

 private:
  struct Asked {
    std::uint64_t frame = ~std::uint64_t{0};  ///< the last that asked
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
