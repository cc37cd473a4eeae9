#include "analysis/scoring/scores.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>

#include "analysis/base/statistics.hpp"
#include "analysis/scoring/law_score.hpp"
#include "analysis/scoring/localisation.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

namespace {

/// In the order of listing. `LawScore::scores` names each of them.
constexpr Metric kMetrics[] = {
    {"coverage", "", Better::kHigher, false, "contacts that fire anything / contacts", "Vestige"},
    {"mapped_area_m2", "m²", Better::kNeither, false, "area of the skin that fires anything, body at rest", "Vestige"},
    {"mapped_share", "", Better::kNeither, false, "mapped area / area of the whole skin", "Vestige"},
    {"area_ratio", "", Better::kLower, false, "largest / smallest area of an actuator", "Vestige"},
    {"localisation_error_mm", "mm", Better::kLower, true,
     "sqrt(mean |Σ A_i v_i / Σ A_i|²) over contacts that fire; v_i: path along the body from the contact to actuator i",
     "amplitude centroid"},
    {"localisation_error_acuities", "", Better::kLower, true,
     "the same, with each contact's error in units of the torso's acuity: 25 mm, at the midline 10 mm", "van Erp 2005"},
    {"energy_localisation_error_mm", "mm", Better::kLower, true,
     "sqrt(mean |Σ A_i² v_i / Σ A_i²|²): phantom assumes this formula, so for phantom it is 0 between actuators by "
     "construction",
     "Israr & Poupyrev 2011"},
    {"slide_ripple", "", Better::kLower, true, "(max - min) / mean of Σ A_i² along a slide, mean over felt slides",
     "Israr & Poupyrev 2011"},
    {"slide_jump_mm", "mm", Better::kLower, true,
     "largest step of Σ A_i x_i / Σ A_i between a slide's contacts, mean over felt slides", "amplitude centroid"},
    {"slide_reversals_per_m", "1/m", Better::kLower, true,
     "steps of Σ A_i x_i / Σ A_i against the collider's, per metre of felt slide", "amplitude centroid"},
    {"timing_f1", "", Better::kHigher, false,
     "2 TP / (2 TP + FP + FN) over frames and actuators: actuators that vibrate, against those that a contact of the "
     "frame asks for",
     "Mesaros et al. 2016"},
    {"onset_error_ms", "ms", Better::kLower, false, "mean time from a contact's instant to its actuator's vibration",
     "Vestige"},
    {"offset_error_ms", "ms", Better::kLower, false, "mean time from the last contact's instant to the vibration's end",
     "Vestige"},
    {"onset_over_15ms", "", Better::kLower, false, "share of onsets later than 15 ms", "Di Luca & Mahnan 2019"},
    {"onset_over_45ms", "", Better::kLower, false, "share of onsets later than 45 ms", "Vogels 2004"},
    {"onset_over_50ms", "", Better::kLower, false, "share of onsets later than 50 ms", "Di Luca & Mahnan 2019"},
    {"information_bits", "bit", Better::kHigher, true,
     "Σ p_ij log2(p_ij / (p_i p_j)): regions of contact, against those that a noisy observer names", "Tan et al. 2010"},
    {"information_categories", "", Better::kHigher, true, "2^information_bits: regions told apart without error",
     "Tan et al. 2010"},
    {"use_evenness", "", Better::kHigher, false, "-Σ p_i log2 p_i / log2 n, p_i: actuator i's share of all duty",
     "Shannon 1948; Pielou 1966"},
    {"mean_duty", "", Better::kNeither, false, "mean of the duties 0 … 1 over frames and actuators", "Vestige"},
    {"peak_duty", "", Better::kLower, false, "the largest frame's mean of the duties 0 … 1 over actuators", "Vestige"},
    {"switches_hz", "Hz", Better::kLower, false, "times that an actuator begins to vibrate, per second and actuator",
     "Vestige"},
    {"ambiguous_share", "", Better::kLower, false,
     "mapped skin that shares its texels with skin more than 50 mm away / mapped skin", "Vestige"},
    {"superseded", "", Better::kLower, true,
     "changed states that a newer state replaced before the line was free / all changed states", "Vestige"},
    {"line_load", "", Better::kLower, true, "bytes sent / bytes that the line can carry in that time", "Vestige"},
};

/// Returns the median step between frames, or 0 for fewer than two frames.
double usual_step_s(const ContactRecording& recording) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < recording.frames(); ++k) steps.push_back(recording.time_s[k] - recording.time_s[k - 1]);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// Returns the middle of the body from right to left, if it is turned to face +z.
double middle_x_m(const ActuatorLayout& layout) {
  if (layout.surface().position_m().empty()) return 0;
  const Box box = box_around(layout.surface().position_m());
  return turned_to_front(0.5 * (box.low + box.high), layout.facing()).x;
}

/// Goes through the recording once. Calls `told(law, contact, error in metres)` for every contact under every law.
template <typename Told>
void judge(const ContactRecording& recording, const ActuatorLayout& layout, std::deque<LawScore>& laws, Told&& told) {
  const double midline_x_m = middle_x_m(layout);
  JudgedContact contact;
  SlideFinder slides;
  for (std::size_t k = 0; k < recording.frames(); ++k) {
    const double time_s = recording.time_s[k];
    const double step_s = k == 0 ? 0 : time_s - recording.time_s[k - 1];
    for (LawScore& law : laws) law.begin_frame(k, time_s);
    for (std::size_t c = recording.first[k]; c < recording.first[k + 1]; ++c) {
      const Contact& found = recording.contacts[c];
      layout.locate(found, contact.located);
      contact.column = recording.column[c];
      contact.frame = k;
      contact.instant_s = time_s - step_s * (1 - static_cast<double>(found.t));
      const std::span<const float> distance_m = contact.located.distance_m();
      contact.region = contact.located.actuator != 0
                           ? contact.located.actuator - 1U
                           : static_cast<std::size_t>(std::ranges::min_element(distance_m) - distance_m.begin());
      contact.acuity_m = acuity_m(turned_to_front(contact.located.position_m, layout.facing()), midline_x_m);
      if (slides.breaks(contact.column, contact.instant_s, contact.located.position_m))
        for (LawScore& law : laws) law.end_chain(contact.column, slides);
      const SlideFinder::Step step = slides.add(contact.column, contact.instant_s, contact.located.position_m);
      for (std::size_t i = 0; i < laws.size(); ++i) {
        told(i, c, laws[i].add(contact));
        laws[i].add_to_slide(contact, slides, step);
      }
    }
    for (LawScore& law : laws) law.end_frame(k, time_s);
  }
  for (std::uint32_t column = 0; column < slides.columns(); ++column)
    for (LawScore& law : laws) law.end_chain(column, slides);
}

}  // namespace

std::span<const Metric> metrics() {
  return kMetrics;
}

std::vector<Scores> score_all(const ContactRecording& recording, const ActuatorLayout& layout,
                              std::span<const LawChoice> choices) {
  const double frame_s = usual_step_s(recording);
  std::deque<LawScore> laws;
  for (const LawChoice& choice : choices) laws.emplace_back(layout, choice, frame_s);
  if (layout.actuator_count() != 0) judge(recording, layout, laws, [](std::size_t, std::size_t, double) {});
  const double duration_s = recording.frames() == 0 ? 0 : recording.time_s.back() - recording.time_s.front() + frame_s;
  std::vector<Scores> scores;
  scores.reserve(laws.size());
  for (LawScore& law : laws) scores.push_back(law.scores(duration_s, recording.frames()));
  return scores;
}

Scores score(const ContactRecording& recording, const ActuatorLayout& layout, const LawChoice& choice) {
  return score_all(recording, layout, {&choice, 1}).front();
}

std::vector<float> contact_errors_mm(const ContactRecording& recording, const ActuatorLayout& layout,
                                     const LawChoice& choice) {
  std::vector<float> errors_mm(recording.contacts.size(), static_cast<float>(kMissing));
  if (layout.actuator_count() == 0) return errors_mm;
  std::deque<LawScore> laws;
  laws.emplace_back(layout, choice, usual_step_s(recording));
  judge(recording, layout, laws, [&](std::size_t, std::size_t contact, double error_m) {
    errors_mm[contact] = static_cast<float>(1e3 * error_m);
  });
  return errors_mm;
}

}  // namespace vestige
