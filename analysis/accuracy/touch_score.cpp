#include "analysis/accuracy/touch_score.hpp"

namespace vestige {

namespace {

constexpr double kFrameRounding_s = 1e-9;

/// One collider's events of truth and test, and its true touches.
class ColliderTouches {
 public:
  ColliderTouches(std::span<const ContactEvent> truth, std::span<const ContactEvent> test, const TouchFrames& frames)
      : truth_(truth), test_(test), touches_(touches_of(truth, frames.is_sphere)), frames_(frames) {}

  void add_to(TouchScore& score) {
    for (std::uint64_t frame = 1; frame <= frames_.last; ++frame) add(frame, score);
  }

 private:
  void add(std::uint64_t frame, TouchScore& score) {
    // A frame tells what happens since the frame before. One more to each side is left out.
    const double from_s = (static_cast<double>(frame) - 2) / frames_.rate_hz - kFrameRounding_s;
    const double to_s = (static_cast<double>(frame) + 1) / frames_.rate_hz + kFrameRounding_s;
    while (touch_ < touches_.size() && end_of(touches_[touch_]) < from_s) ++touch_;
    while (reported_ < test_.size() && test_[reported_].last_frame < frame) ++reported_;
    const bool is_reported = reported_ < test_.size() && test_[reported_].first_frame <= frame;
    if (touch_ == touches_.size() || touches_[touch_].impact_s > to_s) {
      ++score.outside;
      if (is_reported) ++score.false_frames;
    } else if (touches_[touch_].impact_s <= from_s && touches_[touch_].last_s >= to_s) {
      ++score.within;
      if (!is_reported) return;
      ++score.reported;
      if (!is_true_actuator(test_[reported_].actuator, from_s, to_s)) ++score.wrong_actuator;
    }
  }

  /// A touch ends before the next frame of the truth.
  double end_of(const ContactEvent& touch) const { return touch.last_s + 1 / frames_.truth_rate_hz; }

  bool is_true_actuator(std::uint16_t actuator, double from_s, double to_s) {
    while (part_ < truth_.size() && end_of(truth_[part_]) < from_s) ++part_;
    for (std::size_t i = part_; i < truth_.size() && truth_[i].impact_s <= to_s; ++i)
      if (truth_[i].actuator == actuator) return true;
    return false;
  }

  std::span<const ContactEvent> truth_;
  std::span<const ContactEvent> test_;
  std::vector<ContactEvent> touches_;
  const TouchFrames& frames_;
  std::size_t touch_ = 0;  ///< the first touch, event of `test_` and event of `truth_` that may still matter
  std::size_t reported_ = 0;
  std::size_t part_ = 0;
};

}  // namespace

std::vector<ContactEvent> touches_of(std::span<const ContactEvent> events, const std::vector<bool>& is_sphere) {
  std::vector<ContactEvent> touches;
  for (const ContactEvent& event : events) {
    const bool goes_on = is_sphere[event.column] && !touches.empty() && touches.back().column == event.column &&
                         touches.back().last_frame + 1 >= event.first_frame;
    if (goes_on) {
      touches.back().last_frame = event.last_frame;
      touches.back().last_s = event.last_s;
    } else {
      touches.push_back(event);
      if (is_sphere[event.column]) touches.back().actuator = 0;
    }
  }
  return touches;
}

TouchScore& TouchScore::operator+=(const TouchScore& other) {
  within += other.within;
  reported += other.reported;
  wrong_actuator += other.wrong_actuator;
  outside += other.outside;
  false_frames += other.false_frames;
  return *this;
}

TouchScore score_touches(std::span<const ContactEvent> truth, std::span<const ContactEvent> test,
                         const TouchFrames& frames) {
  TouchScore score;
  for (std::uint32_t column = 0; column < frames.is_sphere.size(); ++column)
    if (frames.is_sphere[column])
      ColliderTouches(events_of(truth, column), events_of(test, column), frames).add_to(score);
  return score;
}

}  // namespace vestige
