#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "traces/motion/bvh.hpp"

namespace vestige {

/// Places of all joints at up to 256 times, spread evenly over a motion.
struct MotionSamples {
  std::vector<std::vector<BvhPlace>> now;
  std::vector<std::vector<BvhPlace>> later;  ///< a tenth of a second after each of `now`, or at the motion's end
};

MotionSamples sample_motion(const BvhMotion& motion);

/// The direction that is up in a motion, and what tells it.
struct UpAxis {
  enum class By {
    kGround,   ///< the floor on which the body stands, lies or crawls
    kRest,     ///< the skeleton at rest is a standing person
    kAssumed,  ///< nothing tells: +Y
    kAsked,    ///< the user
  };
  glm::dvec3 up = glm::dvec3(0, 1, 0);  ///< an axis of the file, or its negative
  By by = By::kAssumed;
};

/// Finds the direction that is up: +Y, -Y, +Z or -Z, or `of_rest`, the direction from feet to head of a skeleton that
/// rests as a standing person does. It is the one in which the motion has a floor: the body's lowest point stays at
/// nearly the same height, near zero, and does not slide. The direction of the spine does not count, because people lie
/// down. Returns `of_rest`, or otherwise +Y, if no direction has clearly more of a floor. `body` are the joints that
/// are bones of a body: others may lie anywhere.
UpAxis find_up(const BvhMotion& motion, const std::vector<std::size_t>& body, const MotionSamples& samples,
               const std::optional<glm::dvec3>& of_rest);

/// Returns the height of the lowest end of a bone of `body`, in the motion's unit: the height under which it is in 2 %
/// of the samples.
double floor_level(const BvhMotion& motion, const std::vector<std::size_t>& body, const MotionSamples& samples,
                   const glm::dvec3& up);

}  // namespace vestige
