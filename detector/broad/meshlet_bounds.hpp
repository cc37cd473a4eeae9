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

/// Returns the largest |s - 1| of the avatar, where s is the sum of a vertex's weights. Returns infinity if a weight is
/// negative or not a number.
double weight_excess(const Avatar& avatar);

/// A palette matrix, and the absolute values of its first three columns.
struct alignas(16) BoundTransform {
  std::array<glm::vec4, 4> column;
  std::array<glm::vec4, 3> magnitude;
};

/// The motion of the skin in a frame, as far as its bounds need it.
struct BoundMotion {
  const BoundTransform* now;    ///< of each palette entry
  const BoundTransform* other;  ///< kCcd: before; kCarried: what changed since
  Method method;
  const glm::vec4& pad;  ///< margin that covers the error of the computed boxes
};

/// Boxes around the nodes of `Meshlets` within a frame, computed from the palette alone: nothing is skinned. A segment
/// that misses a node's box surely misses all of its triangles, as the CPU computes them. A segment that meets the box
/// may meet them or not.
///
/// Proof: under linear blend skinning a vertex is s times a convex combination of the points M_j x, where s is the sum
/// of its weights. So the vertex is s times a point of the box around the transformed rest boxes of all its joints.
class MeshletBounds {
 public:
  /// Keeps a reference to `meshlets`.
  MeshletBounds(const Avatar& avatar, const Meshlets& meshlets);

  /// Sets the frame that `boxes` refers to. For `kCcd` the boxes contain the nodes now, before, and at all times
  /// between. For `kCarried` the boxes grow by the displacement that may move a segment's start.
  void begin(const DetectorFrame& frame, Method method);

  /// Returns the boxes of nodes `first` and following in `out`. A box is unbounded (-infinity to infinity) if nothing
  /// is known of the node.
  void boxes(std::size_t level, std::size_t first, std::span<SkinBox> out) const;

  /// Returns the margin of the boxes of this frame: more than the error of a computed place on the skin, and as much
  /// again. Infinite if nothing is known.
  float pad_m() const;

 private:
  const Meshlets& meshlets_;
  std::vector<RestBox>
      extents_;     ///< of each palette entry, over the whole avatar; only half_extent is used: the largest |x|
  float rounding_;  ///< relative error of a bound, to be multiplied by the palette's reach
  float underflow_m_;
  Method method_ = Method::kStatic;
  bool bounded_ = false;
  glm::vec4 pad_ = glm::vec4(0);  ///< margin that covers the error of the computed boxes
  std::vector<BoundTransform> now_;
  std::vector<BoundTransform> other_;  ///< kCcd: the palette before; kCarried: the change since then
};

}  // namespace vestige
