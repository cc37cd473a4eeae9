#include "detector/stages.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

StageClock::StageClock() {
  constexpr int kTries = 16;
  constexpr int kSwitches = 500;
  double least_ns = 0;
  for (int i = 0; i < kTries; ++i) {
    reset();
    for (int k = 0; k < kSwitches; ++k) {
      enter(Stage::kTest);
      enter(Stage::kDecision);
    }
    leave();
    const auto total =
        spent_[static_cast<std::size_t>(Stage::kTest)].time + spent_[static_cast<std::size_t>(Stage::kDecision)].time;
    const double each_ns = static_cast<double>(total.count()) / (2 * kSwitches);
    least_ns = i == 0 ? each_ns : std::min(least_ns, each_ns);
  }
  switch_ns_ = least_ns;
  reset();
}

void StageClock::enter(Stage stage) {
  if (current_ == stage) return;
  const auto now = std::chrono::steady_clock::now();
  if (current_) spent_[static_cast<std::size_t>(*current_)].time += now - since_;
  ++spent_[static_cast<std::size_t>(stage)].entered;
  current_ = stage;
  since_ = now;
}

std::chrono::nanoseconds StageClock::leave() {
  if (!current_) return {};
  const std::chrono::nanoseconds elapsed = std::chrono::steady_clock::now() - since_;
  spent_[static_cast<std::size_t>(*current_)].time += elapsed;
  current_.reset();
  return elapsed;
}

void StageClock::note_draw(std::chrono::nanoseconds wall, std::chrono::nanoseconds timer) {
  drawn_ += timer;
  if (timer > wall) drawn_longer_than_possible_ = true;
}

void StageClock::reset() {
  spent_ = {};
  current_.reset();
  drawn_ = {};
  drawn_longer_than_possible_ = false;
}

std::vector<StageTime> StageClock::times() const {
  std::vector<StageTime> times;
  times.reserve(spent_.size());
  for (std::size_t i = 0; i < spent_.size(); ++i) {
    if (spent_[i].entered == 0) continue;
    const double ns = static_cast<double>(spent_[i].time.count()) - switch_ns_ * static_cast<double>(spent_[i].entered);
    const auto stage = static_cast<Stage>(i);
    times.push_back({stage, std::max(ns, 0.0) / 1000});
    if (stage != Stage::kDraw || drawn_by() != DrawnBy::kTimer) continue;
    const double draw_us = std::min(static_cast<double>(drawn_.count()) / 1000, times.back().us);
    const double wait_us = times.back().us - draw_us;
    times.back().us = draw_us;
    times.push_back({Stage::kWait, wait_us});
  }
  return times;
}

DrawnBy StageClock::drawn_by() const {
  if (spent_[static_cast<std::size_t>(Stage::kDraw)].entered == 0) return DrawnBy::kNothing;
  return drawn_.count() > 0 && !drawn_longer_than_possible_ ? DrawnBy::kTimer : DrawnBy::kClock;
}

}  // namespace vestige
