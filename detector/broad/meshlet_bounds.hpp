#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "detector/broad/meet_boxes.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A palette matrix, and what its first three columns' magnitudes are.
struct alignas(16) BoundTransform {
  std::array<glm::vec4, 4> column;
  std::array<glm::vec4, 3> magnitude;
};

/// How the skin moves in a frame, as its bounds need it.
struct BoundMotion {
  const BoundTransform* now;    ///< of each palette entry
  const BoundTransform* other;  ///< kCcd: before; kCarried: what changed since
  Method method;
  const glm::vec4& pad;  ///< how much larger the boxes must be than they are computed
};

/// Where the nodes of `Meshlets` may be within a frame, from the palette alone: nothing is skinned. A segment that
/// misses a node's box surely misses all of its triangles, as the CPU computes them; meeting the box proves nothing.
///
/// Under linear blend skinning a vertex is s times a convex combination of the points M_j x, where s is the sum of its
/// weights. So it is s times a point of the box around all of its joints' transformed rest boxes.
class MeshletBounds {
 public:
  /// Keeps a reference to `meshlets`.
  MeshletBounds(const Avatar& avatar, const Meshlets& meshlets);

  /// From here on, boxes are of this frame. For `kCcd` they hold the nodes now, before, and all the way between; for
  /// `kCarried` they are grown by the way that they may carry a segment's start.
  void begin(const Frame& frame, Method method);

  /// The boxes of nodes `first` and following. Without bounds (-infinity to infinity) where nothing is known.
  void boxes(std::size_t level, std::size_t first, std::span<SkinBox> out) const;

 private:
  const Meshlets& meshlets_;
  std::vector<RestBox> extents_;  ///< of each palette entry, over the whole avatar; only half_extent: largest |x|
  float rounding_;                ///< of a bound, times the reach of the palette
  float underflow_m_;
  Method method_ = Method::kStatic;
  bool bounded_ = false;
  glm::vec4 pad_ = glm::vec4(0);  ///< how much larger the boxes must be than they are computed
  std::vector<BoundTransform> now_;
  std::vector<BoundTransform> other_;  ///< kCcd: before; kCarried: what changed since
};

}  // namespace vestige
