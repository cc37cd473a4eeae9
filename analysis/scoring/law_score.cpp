#include "analysis/scoring/law_score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "analysis/base/statistics.hpp"
#include "analysis/scoring/balance.hpp"
#include "analysis/scoring/localisation.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/actuators/portable_math.hpp"

namespace vestige {

namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMilliseconds = 1e3;

/// Returns a shared pointer for laws that does not own the layout. The caller keeps the layout alive.
std::shared_ptr<const ActuatorLayout> borrow(const ActuatorLayout& layout) {
  return {std::shared_ptr<const ActuatorLayout>(), &layout};
}

/// Returns the time in seconds after which a motor that goes from `amplitude` to `settled` reaches `threshold`.
double crossing_s(const Motor& motor, double amplitude, double settled, double threshold) {
  const double tau_s = settled > amplitude ? motor.rise_s : motor.fall_s;
  return tau_s * portable_log2((amplitude - settled) / (threshold - settled)) * 0x1.62e42fefa39efp-1;
}

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : kMissing;
}

struct NamedScore {
  std::string_view metric;
  double value;
};

/// Throws `std::logic_error` unless each metric has exactly one score.
Scores in_order_of_metrics(std::span<const NamedScore> named) {
  if (named.size() != metrics().size())
    throw std::logic_error(fmt::format("there are {} scores for {} metrics", named.size(), metrics().size()));
  Scores scores;
  scores.reserve(named.size());
  for (const Metric& metric : metrics()) {
    const auto found = std::ranges::find(named, std::string_view(metric.name), &NamedScore::metric);
    if (found == named.end()) throw std::logic_error(fmt::format("the metric '{}' has no score", metric.name));
    scores.push_back(found->value);
  }
  return scores;
}

}  // namespace

LawScore::LawScore(const ActuatorLayout& layout, const LawChoice& choice, double frame_s)
    : layout_(layout),
      choice_(choice),
      contact_lasts_s_(std::max(choice.options.hold_s, frame_s)),
      law_(make_law(choice.name, borrow(layout), choice.options)),
      held_(layout.actuator_count(), choice.options.hold_s, law_->hold_rule()),
      amplitude_(layout.actuator_count(), 0),
      duty_(layout.actuator_count(), 0),
      use_(layout.actuator_count(), 0),
      observer_(layout.actuator_count()),
      timing_(layout.actuator_count()),
      link_(state_bytes(layout.actuator_count()), choice.line_bytes_per_s) {
  if (!choice.actuators) return;
  for (const Motor& motor : choice.actuators->motors(layout.map())) responses_.push_back({.motor = motor});
}

void LawScore::begin_frame(std::uint64_t frame, double time_s) {
  if (started_ && !responses_.empty()) advance_motors(frame - 1, time_s);
  held_.begin(time_s);
}

void LawScore::feel_shares(const LocatedContact& contact) {
  law_->spread(contact, shares_);
  if (responses_.empty()) return;
  felt_.clear();
  for (const Share& share : shares_) {
    const Motor& motor = responses_[share.actuator].motor;
    const double reached = motor.after(0, motor.duty(share.amplitude), contact_lasts_s_);
    if (reached >= motor.felt_threshold && reached > 0) felt_.push_back({share.actuator, reached});
  }
}

double LawScore::add(const JudgedContact& contact) {
  feel_shares(contact.located);
  held_.add(contact.column, shares_);
  for (const Share& share : shares_) timing_.ask(share.actuator, contact.frame, contact.instant_s);
  if (shares_.empty()) timing_.ask_nothing();

  ++contacts_;
  const std::vector<Share>& felt = responses_.empty() ? shares_ : felt_;
  if (felt.empty()) {
    observer_.add_unfelt(contact.region);
    return kMissing;
  }
  ++fired_;
  double error_m = 0;
  double energy_error_m = 0;
  if (felt.size() == 1) {
    error_m = energy_error_m = static_cast<double>(contact.located.distance_m()[felt.front().actuator]);
    observer_.add_single(contact.region, felt.front().actuator);
  } else {
    const FeltOffset offset = felt_offset(layout_, contact.located, felt);
    error_m = glm::length(offset.amplitude_m);
    energy_error_m = glm::length(offset.energy_m);
    observer_.add(contact.region, layout_, contact.located, offset.amplitude_m);
  }
  squared_error_m2_ += error_m * error_m;
  squared_energy_error_m2_ += energy_error_m * energy_error_m;
  const double acuities = error_m / contact.acuity_m;
  squared_acuities_ += acuities * acuities;
  return error_m;
}

void LawScore::add_to_slide(const JudgedContact& contact, const SlideFinder& slides, SlideFinder::Step step) {
  if (contact.column >= smoothness_.size()) smoothness_.resize(contact.column + 1);
  SlideSmoothness& smoothness = smoothness_[contact.column];
  if (step == SlideFinder::Step::kBegins) smoothness = SlideSmoothness();
  const std::vector<Share>& felt = responses_.empty() ? shares_ : felt_;
  double energy = 0;
  double weights = 0;
  glm::dvec3 middle_m(0);
  for (const Share& share : felt) {
    energy += share.amplitude * share.amplitude;
    weights += share.amplitude;
    middle_m += share.amplitude * layout_.position_m(share.actuator);
  }
  if (weights > 0) middle_m /= weights;
  smoothness.add(energy, weights > 0 ? &middle_m : nullptr, slides.step_m(contact.column));
}

void LawScore::end_chain(std::uint32_t column, const SlideFinder& slides) {
  if (column < smoothness_.size() && slides.is_slide(column))
    slide_score_.add(smoothness_[column], slides.way_m(column));
}

void LawScore::advance_motors(std::uint64_t frame, double time_s) {
  const double step_s = time_s - last_time_s_;
  for (std::size_t i = 0; i < responses_.size(); ++i) {
    Response& response = responses_[i];
    if (response.felt == 0 && duty_[i] == 0) continue;
    const Motor& motor = response.motor;
    const double before = response.felt;
    response.felt = motor.after(before, duty_[i], step_s);
    if (response.felt < 1e-6) response.felt = 0;
    const double threshold = motor.felt_threshold;
    const auto is_felt = [&](double amplitude) { return amplitude > 0 && amplitude >= threshold; };
    if (is_felt(std::max(before, response.felt))) timing_.vibrates(i, frame);
    const bool is_on = is_felt(response.felt);
    if (is_on == timing_.is_on(i)) continue;
    const double settled = motor.settled(duty_[i]);
    const double at_s = last_time_s_ + std::clamp(crossing_s(motor, before, settled, threshold), 0.0, step_s);
    if (is_on) {
      ++switches_;
      timing_.begins(i, at_s);
    } else {
      timing_.ends(i, at_s);
    }
  }
}

void LawScore::end_frame(std::uint64_t frame, double time_s) {
  const std::vector<double>& now = held_.now();
  bool changed = !started_;
  double sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double amplitude = now[i];
    if (amplitude == 0 && amplitude_[i] == 0 && duty_[i] == 0) continue;
    std::uint8_t duty = duty_[i];
    if (!responses_.empty()) {
      Response& response = responses_[i];
      duty = drive(response.motor, amplitude, time_s, duty, response.kick_until_s);
      if (amplitude == 0 && !timing_.is_on(i)) timing_.gives_up(i);
      const double told = duty / 255.0;
      use_[i] += told;
      sum += told;
    } else {
      if (amplitude != amplitude_[i]) duty = static_cast<std::uint8_t>(std::lround(255 * amplitude));
      if (duty != 0) timing_.vibrates(i, frame);
      if (duty != 0 && duty_[i] == 0) {
        ++switches_;
        timing_.begins(i, time_s);
      } else if (duty == 0 && duty_[i] != 0) {
        timing_.ends(i, time_s);
      } else if (amplitude == 0) {
        timing_.gives_up(i);
      }
      use_[i] += amplitude;
      sum += amplitude;
    }
    amplitude_[i] = amplitude;
    if (duty != duty_[i]) {
      duty_[i] = duty;
      changed = true;
    }
  }
  peak_ = std::max(peak_, sum);
  if (changed) link_.post(time_s);
  started_ = true;
  last_time_s_ = time_s;
}

Scores LawScore::scores(double duration_s, std::size_t frames) {
  if (started_) link_.finish(last_time_s_);
  const auto actuators = static_cast<double>(layout_.actuator_count());
  const auto fired = static_cast<double>(fired_);
  double use = 0;
  double least_area_m2 = std::numeric_limits<double>::infinity();
  double most_area_m2 = 0;
  for (std::size_t i = 0; i < use_.size(); ++i) {
    use += use_[i];
    least_area_m2 = std::min(least_area_m2, layout_.area_m2(i));
    most_area_m2 = std::max(most_area_m2, layout_.area_m2(i));
  }
  const double bits = observer_.bits(layout_);
  const NamedScore named[] = {
      {"coverage", ratio(fired, static_cast<double>(contacts_))},
      {"mapped_area_m2", layout_.mapped_area_m2()},
      {"mapped_share", ratio(layout_.mapped_area_m2(), layout_.skin_area_m2())},
      {"area_ratio", ratio(most_area_m2, least_area_m2)},
      {"localisation_error_mm", std::sqrt(ratio(squared_error_m2_, fired)) * kMillimetres},
      {"localisation_error_acuities", std::sqrt(ratio(squared_acuities_, fired))},
      {"energy_localisation_error_mm", std::sqrt(ratio(squared_energy_error_m2_, fired)) * kMillimetres},
      {"slide_ripple", slide_score_.ripple()},
      {"slide_jump_mm", slide_score_.largest_jump_m() * kMillimetres},
      {"slide_reversals_per_m", slide_score_.reversals_per_m()},
      {"timing_f1", timing_.f1()},
      {"onset_error_ms", timing_.mean_onset_s() * kMilliseconds},
      {"offset_error_ms", timing_.mean_offset_s() * kMilliseconds},
      {"onset_over_15ms", timing_.late_share(0)},
      {"onset_over_45ms", timing_.late_share(1)},
      {"onset_over_50ms", timing_.late_share(2)},
      {"information_bits", bits},
      {"information_categories", portable_exp(bits * 0x1.62e42fefa39efp-1)},
      {"use_evenness", use_evenness(use_)},
      {"mean_duty", ratio(use, actuators * static_cast<double>(frames))},
      {"peak_duty", ratio(peak_, actuators)},
      {"switches_hz", ratio(static_cast<double>(switches_), actuators * duration_s)},
      {"ambiguous_share", layout_.ambiguous_share()},
      {"superseded", ratio(static_cast<double>(link_.superseded()), static_cast<double>(link_.changes()))},
      {"line_load", ratio(link_.bytes_sent(), choice_.line_bytes_per_s * duration_s)},
  };
  return in_order_of_metrics(named);
}

}  // namespace vestige
