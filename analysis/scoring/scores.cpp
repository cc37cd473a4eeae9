#include "analysis/scoring/scores.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>

#include "analysis/base/statistics.hpp"
#include "analysis/scoring/law_score.hpp"
#include "analysis/scoring/localisation.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

namespace {

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
void judge(const ContactRecording& recording, const ScoredLayout& scored, std::deque<LawScore>& laws, Told&& told) {
  const ActuatorLayout& layout = *scored.layout;
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
      if (scored.covered != nullptr) contact.located.covered = scored.covered->of(c);
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

std::vector<Scores> score_all(const ContactRecording& recording, std::span<const ScoredLayout> layouts,
                              std::span<const LawChoice> choices) {
  const double frame_s = usual_step_s(recording);
  const std::size_t contacts = recording.contacts.size();
  const auto felt_by_all = std::make_unique<bool[]>(contacts);
  std::fill_n(felt_by_all.get(), contacts, true);
  std::vector<std::deque<LawScore>> laws_of(layouts.size());
  std::vector<std::vector<float>> errors_m;  // of each layout and law, by contact
  errors_m.reserve(layouts.size() * choices.size());
  for (std::size_t l = 0; l < layouts.size(); ++l) {
    for (const LawChoice& choice : choices) laws_of[l].emplace_back(*layouts[l].layout, choice, frame_s);
    const std::size_t first = errors_m.size();
    errors_m.resize(first + choices.size(), std::vector<float>(contacts, static_cast<float>(kMissing)));
    if (layouts[l].layout->actuator_count() != 0)
      judge(recording, layouts[l], laws_of[l], [&](std::size_t law, std::size_t contact, double error_m) {
        errors_m[first + law][contact] = static_cast<float>(error_m);
      });
    for (std::size_t law = first; law < errors_m.size(); ++law)
      for (std::size_t i = 0; i < contacts; ++i) felt_by_all[i] = felt_by_all[i] && !std::isnan(errors_m[law][i]);
  }

  const double duration_s = recording.frames() == 0 ? 0 : recording.time_s.back() - recording.time_s.front() + frame_s;
  std::vector<Scores> scores;
  scores.reserve(errors_m.size());
  for (std::deque<LawScore>& laws : laws_of)
    for (LawScore& law : laws) {
      law.compare({felt_by_all.get(), contacts}, errors_m[scores.size()]);
      scores.push_back(law.scores(duration_s, recording.frames()));
    }
  return scores;
}

std::vector<Scores> score_all(const ContactRecording& recording, const ScoredLayout& layout,
                              std::span<const LawChoice> choices) {
  return score_all(recording, {&layout, 1}, choices);
}

Scores score(const ContactRecording& recording, const ScoredLayout& layout, const LawChoice& choice) {
  return score_all(recording, layout, {&choice, 1}).front();
}

std::vector<float> contact_errors_mm(const ContactRecording& recording, const ScoredLayout& layout,
                                     const LawChoice& choice) {
  std::vector<float> errors_mm(recording.contacts.size(), static_cast<float>(kMissing));
  if (layout.layout->actuator_count() == 0) return errors_mm;
  std::deque<LawScore> laws;
  laws.emplace_back(*layout.layout, choice, usual_step_s(recording));
  judge(recording, layout, laws, [&](std::size_t, std::size_t contact, double error_m) {
    errors_mm[contact] = static_cast<float>(1e3 * error_m);
  });
  return errors_mm;
}

}  // namespace vestige
