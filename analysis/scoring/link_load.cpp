#include "analysis/scoring/link_load.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

namespace {

constexpr double kFloor_s = 0.005;
constexpr double kRefresh_s = 0.020;

}  // namespace

std::size_t state_bytes(std::size_t actuator_count) {
  const std::size_t packet = 4 + actuator_count + 2;
  return packet + 1 + packet / 254 + 1;
}

LinkLoad::LinkLoad(std::size_t frame_bytes, double line_bytes_per_s)
    : frame_bytes_(static_cast<double>(frame_bytes)),
      pause_s_(std::max(kFloor_s, frame_bytes_ / line_bytes_per_s)),
      refresh_s_(std::max(kRefresh_s, pause_s_)) {}

void LinkLoad::post(double time_s) {
  run_to(time_s);
  ++changes_;
  if (waiting_) ++superseded_;
  waiting_ = true;
  if (!linked_ || time_s >= last_sent_s_ + pause_s_) send(time_s);
}

void LinkLoad::run_to(double time_s) {
  if (!linked_) return;
  if (waiting_ && last_sent_s_ + pause_s_ <= time_s) send(last_sent_s_ + pause_s_);
  if (waiting_) return;
  const double refreshes = std::floor((time_s - last_sent_s_) / refresh_s_);
  if (!(refreshes > 0)) return;
  sent_ += static_cast<std::uint64_t>(refreshes);
  last_sent_s_ += refreshes * refresh_s_;
}

void LinkLoad::send(double time_s) {
  linked_ = true;
  waiting_ = false;
  last_sent_s_ = time_s;
  ++sent_;
}

}  // namespace vestige
