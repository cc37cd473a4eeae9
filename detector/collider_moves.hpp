#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// The motion of one collider from the previous frame of a trace to this frame, in the world.
struct ColliderMove {
  glm::dvec3 start_m = glm::dvec3(0);
  glm::dvec3 end_m = glm::dvec3(0);
  double radius_m = 0;       ///< of the sphere whose centre moves; 0: a point
  std::uint32_t column = 0;  ///< of the collision texture
  std::uint16_t owner = kNobody;
};

/// Follows the colliders of a trace from frame to frame, for all of its people together: detector/CONTRACT.md, 1.
class ColliderMoves {
 public:
  /// `collider_ids` is ascending; the rank of an id is the column of the collider. Colliders with other ids are
  /// ignored.
  explicit ColliderMoves(std::span<const std::uint32_t> collider_ids);

  /// Takes the next frame of the trace. If the indices leave a gap (a damaged trace), nothing has moved.
  void next(const TraceFrame& trace_frame);

  std::size_t columns() const { return columns_.size(); }
  /// The moves of the frame taken last, by ascending columns, at most one for each column.
  std::span<const ColliderMove> moves() const { return moves_; }

 private:
  struct Column {
    glm::dvec3 position_m = glm::dvec3(0);
    /// 1 + index of the last frame that had the collider; 0 if no frame had it, or if it teleported since.
    std::uint64_t seen_in = 0;
  };

  std::vector<std::uint32_t> collider_ids_;
  std::vector<Column> columns_;
  std::vector<ColliderMove> moves_;
};

}  // namespace vestige
