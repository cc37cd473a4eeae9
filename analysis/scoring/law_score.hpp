#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/scoring/information.hpp"
#include "analysis/scoring/link_load.hpp"
#include "analysis/scoring/scores.hpp"
#include "analysis/scoring/slide_score.hpp"
#include "analysis/scoring/timing_score.hpp"

namespace vestige {

/// A contact, and what every law may ask of it.
struct JudgedContact {
  std::uint32_t column = 0;
  std::uint64_t frame = 0;
  double instant_s = 0;
  std::size_t region = 0;  ///< its actuator, else the nearest, from 0
  double acuity_m = 0;
  LocatedContact located;
};

/// Gathers what one law makes of one recording. For each frame: `begin_frame`, its contacts, `end_frame`.
class LawScore {
 public:
  /// `layout` stays. `frame_s`: the recording's usual step.
  LawScore(const ActuatorLayout& layout, const LawChoice& choice, double frame_s);

  void begin_frame(std::uint64_t frame, double time_s);
  /// Returns the localisation error, metres; NaN where nothing fires.
  double add(const JudgedContact& contact);
  /// After `add`: what it means for the slide that the collider is on.
  void add_to_slide(const JudgedContact& contact, const SlideFinder& slides, SlideFinder::Step step);
  /// The chain of contacts of `column` ends; `slides` still knows of it.
  void end_chain(std::uint32_t column, const SlideFinder& slides);
  void end_frame(std::uint64_t frame, double time_s);

  /// Of the whole recording, at its end.
  Scores scores(double duration_s, std::size_t frames);

 private:
  /// One actuator's motor, from what it is told to what is felt.
  struct Response {
    Motor motor;
    double felt = 0;
    double kick_until_s = -1e300;
  };

  void feel_shares(const LocatedContact& contact);
  void advance_motors(std::uint64_t frame, double time_s);

  const ActuatorLayout& layout_;
  LawChoice choice_;
  double contact_lasts_s_;  ///< alone
  std::unique_ptr<IntensityLaw> law_;
  HeldAmplitudes held_;
  std::vector<Response> responses_;  ///< empty: ideal motors
  std::vector<Share> shares_;        ///< what the last contact asks for
  std::vector<Share> felt_;          ///< and what it gets
  std::vector<double> amplitude_;    ///< told in the frame before
  std::vector<std::uint8_t> duty_;
  std::vector<double> use_;
  double last_time_s_ = 0;
  bool started_ = false;

  std::uint64_t contacts_ = 0;
  std::uint64_t fired_ = 0;
  double squared_error_m2_ = 0;
  double squared_acuities_ = 0;
  double squared_energy_error_m2_ = 0;
  double peak_ = 0;
  std::uint64_t switches_ = 0;
  RegionObserver observer_;
  TimingScore timing_;
  LinkLoad link_;
  std::vector<SlideSmoothness> smoothness_;  ///< by column: of the chain that goes on
  SlideScore slide_score_;
};

}  // namespace vestige
