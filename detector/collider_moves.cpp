#include "detector/collider_moves.hpp"

namespace vestige {

ColliderMoves::ColliderMoves(std::span<const std::uint32_t> collider_ids)
    : collider_ids_(collider_ids.begin(), collider_ids.end()), columns_(collider_ids.size()) {}

void ColliderMoves::next(const TraceFrame& trace_frame) {
  moves_.resize(trace_frame.colliders.size());  // filled in place: one that is built elsewhere and copied costs more
  std::size_t count = 0;
  const bool ascending = visit_next(trace_frame, [&](const ColliderMove& move) { moves_[count++] = move; });
  moves_.resize(count);
  if (!ascending) std::ranges::sort(moves_, {}, &ColliderMove::column);
}

void ColliderMoves::forget_teleported(const TraceFrame& trace_frame) {
  std::size_t next = 0;
  for (const std::uint32_t id : trace_frame.teleported) {
    const std::size_t column = column_of(id, next);
    if (column == columns_.size()) continue;
    columns_[column].seen_in = 0;
    next = column + 1;
  }
}

}  // namespace vestige
