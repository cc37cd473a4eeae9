#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/scoring/information.hpp"
#include "analysis/scoring/law_tally.hpp"
#include "analysis/scoring/scores.hpp"
#include "analysis/scoring/slide_score.hpp"

namespace vestige {

/// A contact, and the values that every law may need.
struct JudgedContact {
  std::uint32_t column = 0;
  std::uint64_t frame = 0;
  double instant_s = 0;
  std::size_t region = 0;  ///< its actuator, otherwise the nearest one; from 0
  double acuity_m = 0;
  LocatedContact located;
};

/// Collects the scores of one law on one recording. For each frame, call `begin_frame`, add the frame's contacts, and
/// call `end_frame`.
class LawScore {
 public:
  /// `layout` must outlive this object. `frame_s` is the recording's usual step.
  LawScore(const ActuatorLayout& layout, const LawChoice& choice, double frame_s);

  void begin_frame(std::uint64_t frame, double time_s);
  /// Adds a contact. Returns the localisation error in metres, or NaN if no actuator is felt.
  double add(const JudgedContact& contact);
  /// Adds the contact to the slide of its collider. Call it after `add`.
  void add_to_slide(const JudgedContact& contact, const SlideFinder& slides, SlideFinder::Step step);
  /// Ends the chain of contacts of `column`. Call it while `slides` still holds the chain.
  void end_chain(std::uint32_t column, const SlideFinder& slides);
  void end_frame(std::uint64_t frame, double time_s);

  /// Tells which contacts of the recording are felt under everything that is compared. `errors_m` has what `add`
  /// returned for each contact.
  void compare(std::span<const bool> felt_by_all, std::span<const float> errors_m);

  /// Returns the scores of the whole recording. Call it at the end.
  Scores scores(double duration_s, std::size_t frames);

 private:
  /// The response of one actuator's motor: what the actuator is told and what is felt.
  struct Response {
    Motor motor;
    double felt = 0;
    double kick_until_s = -1e300;
  };

  void feel_shares(const LocatedContact& contact);
  void add_fired(const Share& share);
  void add_felt(const Share& share);
  /// Returns the amplitude of an actuator that a contact alone drives; 0 if it is not felt.
  double reached_by(std::uint32_t actuator, double amplitude) const;
  void advance_motors(std::uint64_t frame, double time_s);

  const ActuatorLayout& layout_;
  LawChoice choice_;
  double contact_lasts_s_;  ///< how long a contact alone drives a motor
  std::unique_ptr<IntensityLaw> law_;
  std::vector<std::uint32_t> alike_;  ///< `Firing::first_alike`; empty if each region fires its own actuator
  HeldAmplitudes held_;
  std::vector<Response> responses_;  ///< empty: motors are ideal
  std::vector<Share> shares_;        ///< what the last contact asks for, by region
  std::vector<Share> fired_;         ///< what fires for it, by actuator
  std::vector<Share> felt_;          ///< what is felt of it, by region: where it is meant to be felt
  std::vector<double> amplitude_;    ///< amplitudes of the previous frame
  std::vector<double> fired_amplitude_;
  std::vector<std::uint8_t> duty_;
  double last_time_s_ = 0;
  bool started_ = false;

  RegionObserver observer_;
  std::vector<SlideSmoothness> smoothness_;  ///< by column: the smoothness of the current chain
  LawTally all_;
};

}  // namespace vestige
