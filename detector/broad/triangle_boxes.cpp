#include "detector/broad/triangle_boxes.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace vestige {

namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// Returns the lower end of a box after growth. If `start + moved`, rounded to fp32, lies at or above `low`, then
/// `start` lies at or above the result. This holds for every `start`: rounding is monotonic, so start + moved >= the
/// float below `low`.
float grown_down(float low, double moved) {
  const double grown = static_cast<double>(std::nextafter(low, -kUnbounded)) - std::max(moved, 0.0);
  return std::nextafter(static_cast<float>(grown), -kUnbounded);
}

float grown_up(float high, double moved) {
  return -grown_down(-high, -moved);
}

}  // namespace

void TriangleBoxes::build(const Avatar& avatar, const SkinMotion& skin, Method method) {
  count_ = avatar.triangles.size();
  const std::size_t padded = (count_ + kBlock - 1) / kBlock * kBlock;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low_[axis].assign(padded, kUnbounded);
    high_[axis].assign(padded, -kUnbounded);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const glm::uvec3& corner = avatar.triangles[i];
    glm::vec3 low = glm::min(glm::min(skin.now[corner.x], skin.now[corner.y]), skin.now[corner.z]);
    glm::vec3 high = glm::max(glm::max(skin.now[corner.x], skin.now[corner.y]), skin.now[corner.z]);
    if (method == Method::kCcd) {
      low = glm::min(glm::min(low, skin.before[corner.x]), glm::min(skin.before[corner.y], skin.before[corner.z]));
      high = glm::max(glm::max(high, skin.before[corner.x]), glm::max(skin.before[corner.y], skin.before[corner.z]));
    }
    if (method == Method::kCarried) {
      const auto triangle = static_cast<std::uint32_t>(i);
      const glm::dvec3 moved =
          carried_displacement(corners_of(avatar, skin.before, triangle), corners_of(avatar, skin.now, triangle));
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = grown_down(low[axis], moved[axis]);
        high[axis] = grown_up(high[axis], moved[axis]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      low_[static_cast<std::size_t>(axis)][i] = low[axis];
      high_[static_cast<std::size_t>(axis)][i] = high[axis];
    }
  }
}

bool TriangleBoxes::block_meets(std::size_t first, const std::array<float, 3>& low, const std::array<float, 3>& high,
                                std::array<std::uint32_t, kBlock>& meets) const {
  std::uint32_t any = 0;
  const float* low_x = &low_[0][first];
  const float* low_y = &low_[1][first];
  const float* low_z = &low_[2][first];
  const float* high_x = &high_[0][first];
  const float* high_y = &high_[1][first];
  const float* high_z = &high_[2][first];
  for (std::size_t i = 0; i < kBlock; ++i) {
    // Not &&: without branches the compiler tests several boxes at once.
    const bool met =
        static_cast<bool>(static_cast<unsigned>(low_x[i] <= high[0]) & static_cast<unsigned>(high_x[i] >= low[0]) &
                          static_cast<unsigned>(low_y[i] <= high[1]) & static_cast<unsigned>(high_y[i] >= low[1]) &
                          static_cast<unsigned>(low_z[i] <= high[2]) & static_cast<unsigned>(high_z[i] >= low[2]));
    meets[i] = met ? 1U : 0U;
    any |= meets[i];
  }
  return any != 0;
}

}  // namespace vestige
