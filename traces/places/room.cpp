#include "traces/places/room.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kRate_hz = 30;
constexpr double kMostIntervals = 3600;
constexpr std::size_t kVertices = 500;  // about this many vertices represent all

}  // namespace

Room::Room(MovingBody& body) : loop_s_(body.loop_s()) {
  const Avatar& avatar = body.avatar();
  const std::size_t stride = std::max<std::size_t>(avatar.position_bind.size() / kVertices, 1);
  const auto intervals = static_cast<int>(std::clamp(std::ceil(loop_s_ * kRate_hz), 0.0, kMostIntervals));
  std::vector<glm::dmat4> palette;
  std::vector<glm::dvec3> places;
  for (int i = 0; i <= intervals; ++i) {
    const double time_s = intervals > 0 ? loop_s_ * i / intervals : 0;
    // The end of the loop, which looping never shows, is where the last moments lead.
    const Animation* animation = body.animation();
    palette_matrices(avatar, animation == nullptr ? rest_pose(avatar) : sample_animation(avatar, *animation, time_s),
                     palette);
    places.clear();
    glm::dvec3 sum(0);
    for (std::size_t vertex = 0; vertex < avatar.position_bind.size(); vertex += stride) {
      places.push_back(skin_vertex(avatar, palette, vertex));
      sum += places.back();
    }
    const glm::dvec3 centre = sum / static_cast<double>(places.size());
    if (centres_m_.empty()) {
      low_m_ = body.box_m().low - centre;
      high_m_ = body.box_m().high - centre;
    }
    centres_m_.push_back(centre);
    for (const glm::dvec3& place : places) {
      low_m_ = glm::min(low_m_, place - centre);
      high_m_ = glm::max(high_m_, place - centre);
    }
  }
}

glm::dvec3 Room::centre_m(double time_s) const {
  if (centres_m_.size() == 1) return centres_m_.front();
  const double last = static_cast<double>(centres_m_.size() - 1);
  const double place = std::fmod(std::max(time_s, 0.0), loop_s_) / loop_s_ * last;
  const double before = std::min(std::floor(place), last - 1);
  const auto index = static_cast<std::size_t>(before);
  return glm::mix(centres_m_[index], centres_m_[index + 1], place - before);
}

}  // namespace vestige
