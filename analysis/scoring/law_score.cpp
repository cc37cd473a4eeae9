#include "analysis/scoring/law_score.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "analysis/base/statistics.hpp"
#include "analysis/scoring/localisation.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/actuators/portable_math.hpp"

namespace vestige {

namespace {

/// Returns a shared pointer for laws that does not own the layout. The caller keeps the layout alive.
std::shared_ptr<const ActuatorLayout> borrow(const ActuatorLayout& layout) {
  return {std::shared_ptr<const ActuatorLayout>(), &layout};
}

/// Returns the time in seconds after which a motor that goes from `amplitude` to `settled` reaches `threshold`.
double crossing_s(const Motor& motor, double amplitude, double settled, double threshold) {
  const double tau_s = settled > amplitude ? motor.rise_s : motor.fall_s;
  return tau_s * portable_log2((amplitude - settled) / (threshold - settled)) * 0x1.62e42fefa39efp-1;
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
      observer_(layout.actuator_count()),
      all_(layout, choice.line_bytes_per_s, choice.unfelt_m) {
  if (!layout.map().firing.is_own()) alike_ = layout.map().firing.first_alike(layout.actuator_count());
  if (!choice.actuators) return;
  for (const Motor& motor : choice.actuators->motors(layout.map())) responses_.push_back({.motor = motor});
}

void LawScore::begin_frame(std::uint64_t frame, double time_s) {
  if (started_ && !responses_.empty()) advance_motors(frame - 1, time_s);
  held_.begin(time_s);
}

void LawScore::feel_shares(const LocatedContact& contact) {
  law_->spread(contact, shares_);
  fired_.clear();
  felt_.clear();
  for (const Share& share : shares_) {
    double most = 0;
    layout_.map().firing.for_each(share.actuator, [&](const Fired& one) {
      const double amplitude = one.gain * share.amplitude;
      add_fired({one.actuator, amplitude});
      most = std::max(most, reached_by(one.actuator, amplitude));
    });
    if (most > 0) add_felt({share.actuator, most});
  }
  const auto vibrates = [](const Share& share) { return share.amplitude >= kLeastAmplitude; };
  if (std::ranges::any_of(fired_, vibrates)) return;
  fired_.clear();
  felt_.clear();
}

/// Where regions fire the same actuators, nothing is felt between them: the strongest counts.
void LawScore::add_felt(const Share& share) {
  if (!alike_.empty())
    for (Share& other : felt_) {
      if (alike_[other.actuator] != alike_[share.actuator]) continue;
      if (share.amplitude > other.amplitude) other = share;
      return;
    }
  felt_.push_back(share);
}

/// Regions that fire the same actuator ask for it once, the strongest.
void LawScore::add_fired(const Share& share) {
  if (!alike_.empty())
    if (const auto found = std::ranges::find(fired_, share.actuator, &Share::actuator); found != fired_.end()) {
      found->amplitude = std::max(found->amplitude, share.amplitude);
      return;
    }
  fired_.push_back(share);
}

double LawScore::reached_by(std::uint32_t actuator, double amplitude) const {
  if (responses_.empty()) return amplitude;
  const Motor& motor = responses_[actuator].motor;
  const double reached = motor.after(0, motor.duty(amplitude), contact_lasts_s_);
  return reached >= motor.felt_threshold ? reached : 0;
}

double LawScore::add(const JudgedContact& contact) {
  feel_shares(contact.located);
  held_.add(contact.column, shares_);
  for (const Share& share : fired_) all_.timing.ask(share.actuator, contact.frame, contact.instant_s);
  if (fired_.empty()) all_.timing.ask_nothing();

  ++all_.contacts;
  if (felt_.empty()) {
    observer_.add_unfelt(contact.region);
    return kMissing;
  }
  ++all_.felt;
  double error_m = 0;
  double energy_error_m = 0;
  if (felt_.size() == 1) {
    error_m = energy_error_m = static_cast<double>(contact.located.distance_m()[felt_.front().actuator]);
    observer_.add_single(contact.region, felt_.front().actuator);
  } else {
    const FeltOffset offset = felt_offset(layout_, contact.located, felt_);
    error_m = glm::length(offset.amplitude_m);
    energy_error_m = glm::length(offset.energy_m);
    observer_.add(contact.region, layout_, contact.located, offset.amplitude_m);
  }
  all_.squared_error_m2 += error_m * error_m;
  all_.squared_energy_error_m2 += energy_error_m * energy_error_m;
  const double acuities = error_m / contact.acuity_m;
  all_.squared_acuities += acuities * acuities;
  return error_m;
}

void LawScore::add_to_slide(const JudgedContact& contact, const SlideFinder& slides, SlideFinder::Step step) {
  if (contact.column >= smoothness_.size()) smoothness_.resize(contact.column + 1);
  SlideSmoothness& smoothness = smoothness_[contact.column];
  if (step == SlideFinder::Step::kBegins) smoothness = SlideSmoothness();
  double energy = 0;
  double weights = 0;
  glm::dvec3 middle_m(0);
  for (const Share& share : felt_) {
    energy += share.amplitude * share.amplitude;
    weights += share.amplitude;
    middle_m += share.amplitude * layout_.position_m(share.actuator);
  }
  if (weights > 0) middle_m /= weights;
  smoothness.add(energy, weights > 0 ? &middle_m : nullptr, slides.step_m(contact.column));
}

void LawScore::end_chain(std::uint32_t column, const SlideFinder& slides) {
  if (column < smoothness_.size() && slides.is_slide(column))
    all_.slides.add(smoothness_[column], slides.way_m(column));
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
    if (is_felt(std::max(before, response.felt))) all_.timing.vibrates(i, frame);
    const bool is_on = is_felt(response.felt);
    if (is_on == all_.timing.is_on(i)) continue;
    const double settled = motor.settled(duty_[i]);
    const double at_s = last_time_s_ + std::clamp(crossing_s(motor, before, settled, threshold), 0.0, step_s);
    if (is_on) {
      ++all_.switches;
      all_.timing.begins(i, at_s);
    } else {
      all_.timing.ends(i, at_s);
    }
  }
}

void LawScore::end_frame(std::uint64_t frame, double time_s) {
  const std::vector<double>& now = layout_.map().firing.apply(held_.now(), fired_amplitude_);
  bool changed = !started_;
  double sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double amplitude = now[i];
    if (amplitude == 0 && amplitude_[i] == 0 && duty_[i] == 0) continue;
    std::uint8_t duty = duty_[i];
    if (!responses_.empty()) {
      Response& response = responses_[i];
      duty = drive(response.motor, amplitude, time_s, duty, response.kick_until_s);
      if (amplitude == 0 && !all_.timing.is_on(i)) all_.timing.gives_up(i);
      const double told = duty / 255.0;
      all_.use[i] += told;
      sum += told;
    } else {
      if (amplitude != amplitude_[i]) duty = static_cast<std::uint8_t>(std::lround(255 * amplitude));
      if (duty != 0) all_.timing.vibrates(i, frame);
      if (duty != 0 && duty_[i] == 0) {
        ++all_.switches;
        all_.timing.begins(i, time_s);
      } else if (duty == 0 && duty_[i] != 0) {
        all_.timing.ends(i, time_s);
      } else if (amplitude == 0) {
        all_.timing.gives_up(i);
      }
      all_.use[i] += amplitude;
      sum += amplitude;
    }
    amplitude_[i] = amplitude;
    if (duty != duty_[i]) {
      duty_[i] = duty;
      changed = true;
    }
  }
  all_.peak = std::max(all_.peak, sum);
  if (changed) all_.link.post(time_s);
  started_ = true;
  last_time_s_ = time_s;
}

void LawScore::compare(std::span<const bool> felt_by_all, std::span<const float> errors_m) {
  for (std::size_t i = 0; i < errors_m.size(); ++i) {
    if (!felt_by_all[i]) continue;
    ++all_.common;
    all_.squared_common_error_m2 += static_cast<double>(errors_m[i]) * static_cast<double>(errors_m[i]);
  }
}

Scores LawScore::scores(double duration_s, std::size_t frames) {
  if (started_) all_.link.finish(last_time_s_);
  all_.duration_s = duration_s;
  all_.frames = frames;
  all_.information_bits = observer_.bits(layout_);
  Scores scores;
  scores.reserve(metrics().size());
  for (const Metric& metric : metrics()) scores.push_back(metric.value(all_));
  return scores;
}

}  // namespace vestige
