#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/scene/radius.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The motion of one collider from the previous frame of a trace to this frame, in the world.
struct ColliderMove {
  std::uint32_t column = 0;  ///< of the collision texture
  std::uint16_t owner = kNobody;
  float radius_m = 0;  ///< of the sphere whose centre moves; 0: a point
  glm::dvec3 start_m = glm::dvec3(0);
  glm::dvec3 end_m = glm::dvec3(0);
};

/// Follows the colliders of a trace from frame to frame, for all of its people together: detector/CONTRACT.md, 1.
class ColliderMoves {
 public:
  /// `collider_ids` is ascending; the rank of an id is the column of the collider. Colliders with other ids are
  /// ignored.
  explicit ColliderMoves(std::span<const std::uint32_t> collider_ids);

  /// Takes the next frame of the trace. If the indices leave a gap (a damaged trace), nothing has moved.
  void next(const TraceFrame& trace_frame);

  /// The same, but calls visit(move) instead of keeping the moves. Returns whether their columns ascend.
  template <typename Visit>
  bool visit_next(const TraceFrame& trace_frame, Visit&& visit) {
    forget_teleported(trace_frame);
    std::size_t next = 0;
    std::size_t end = 0;  // 1 + the largest column so far
    bool ascending = true;
    for (const ColliderSample& sample : trace_frame.colliders) {
      const std::size_t column = column_of(sample.id, next);
      if (column == columns_.size()) continue;
      next = column + 1;
      Column& before = columns_[column];
      if (before.seen_in != 0 && before.seen_in == trace_frame.index) {
        ascending = ascending && column >= end;
        end = column + 1;
        visit(ColliderMove{.column = static_cast<std::uint32_t>(column),
                           .owner = sample.owner,
                           .radius_m = is_sphere_radius(sample.radius_m) ? sample.radius_m : 0,
                           .start_m = before.position_m,
                           .end_m = sample.position_m});
      }
      before.position_m = sample.position_m;
      before.seen_in = trace_frame.index + 1;
    }
    return ascending;
  }

  std::size_t columns() const { return columns_.size(); }
  /// The moves of the frame taken last, by ascending columns, at most one for each column.
  std::span<const ColliderMove> moves() const { return moves_; }

 private:
  struct Column {
    glm::dvec3 position_m = glm::dvec3(0);
    /// 1 + index of the last frame that had the collider; 0 if no frame had it, or if it teleported since.
    std::uint64_t seen_in = 0;
  };

  void forget_teleported(const TraceFrame& trace_frame);

  /// Returns the column of an id, or their number. Looks at `next` first: ids mostly come in ascending order.
  std::size_t column_of(std::uint32_t id, std::size_t next) const {
    if (next < collider_ids_.size() && collider_ids_[next] == id) return next;
    const auto place = std::ranges::lower_bound(collider_ids_, id);
    return place != collider_ids_.end() && *place == id ? static_cast<std::size_t>(place - collider_ids_.begin())
                                                        : collider_ids_.size();
  }

  std::vector<std::uint32_t> collider_ids_;
  std::vector<Column> columns_;
  std::vector<ColliderMove> moves_;
};

}  // namespace vestige
