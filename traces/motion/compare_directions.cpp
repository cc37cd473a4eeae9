#include "traces/motion/compare_directions.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace vestige {

std::vector<Deviation> compare_directions(const BvhMotion& motion, const Avatar& avatar, const Animation& animation,
                                          const glm::dmat3& to_avatar,
                                          const std::vector<ComparedDirection>& directions) {
  constexpr double kClose = 0.1;
  struct Difference {
    double cosine = 1;
    double length = 0;
  };
  // By direction and frame.
  std::vector<std::vector<Difference>> differences(directions.size(), std::vector<Difference>(motion.frame_count));
  std::vector<BvhPlace> places;
  std::vector<glm::dmat4> world;
  for (std::size_t frame = 0; frame < motion.frame_count; ++frame) {
    bvh_places(motion, frame, places);
    const auto time_s = static_cast<float>(static_cast<double>(frame) * motion.frame_time_s);
    world_matrices(avatar, sample_animation(avatar, animation, double{time_s}), world);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const auto& [what, joints, nodes, tolerance_deg] = directions[i];
      const glm::dvec3 source = to_avatar * (places[joints[1]].position - places[joints[0]].position);
      const glm::dvec3 result(world[nodes[1]][3] - world[nodes[0]][3]);
      const double length = glm::length(source);
      if (!(length > 0) || !(glm::length(result) > 0)) continue;
      differences[i][frame] = {glm::dot(source / length, glm::normalize(result)), length};
    }
  }
  std::vector<Deviation> deviations;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double longest = std::ranges::max(differences[i], {}, &Difference::length).length;
    Deviation most = {directions[i].what, 0, 0};
    for (std::size_t frame = 0; frame < motion.frame_count; ++frame) {
      const auto& [cosine, length] = differences[i][frame];
      const double degrees = glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
      if (length >= kClose * longest && degrees > most.degrees) most = {directions[i].what, degrees, frame};
    }
    if (most.degrees > directions[i].tolerance_deg) deviations.push_back(most);
  }
  return deviations;
}

}  // namespace vestige
