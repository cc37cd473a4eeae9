#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/skinning.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// How a palette entry changed since the palette before: its columns, the absolute values of the first three, and what
/// rounding can hide of a sum of them with any point that the entry moves.
struct alignas(16) EntryMotion {
  std::array<glm::vec4, 4> column;
  std::array<glm::vec4, 3> magnitude;
  glm::vec4 rounding;
};

/// Bounds how far the skin of each part of an avatar moves from one palette to the next. The parts are the nodes of a
/// level of `Meshlets`. "Skin" is here what linear blending gives in real numbers.
class PartMotion {
 public:
  /// Keeps a reference to `meshlets`.
  PartMotion(const Avatar& avatar, const Meshlets& meshlets, std::size_t level);

  /// Returns how far each part can have moved from one palette to the other, in metres; infinite where nothing is
  /// known.
  std::span<const float> between(std::span<const SkinMatrix> before, std::span<const SkinMatrix> now);

 private:
  const Meshlets& meshlets_;
  std::size_t level_;
  float scale_;                       ///< of a displacement, as weights may sum to more than 1
  std::vector<glm::vec4> extent_of_;  ///< of each palette entry: the largest |x| that it moves
  std::vector<EntryMotion> motion_;
  std::vector<float> steps_m_;
};

}  // namespace vestige
