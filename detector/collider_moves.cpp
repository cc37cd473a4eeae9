#include "detector/collider_moves.hpp"

#include <algorithm>

#include "traces/scene/radius.hpp"

namespace vestige {

namespace {

using IdPlace = std::vector<std::uint32_t>::const_iterator;

/// Returns the place of `id` in the ascending `ids`, or their end. Looks at `next` first, and whether the id would
/// stand just before it: ids mostly come in ascending order.
IdPlace place_of(const std::vector<std::uint32_t>& ids, std::uint32_t id, IdPlace next) {
  if (next != ids.end() && *next == id) return next;
  const bool is_before = next == ids.end() || id < *next;
  if (is_before && (next == ids.begin() || id > *(next - 1))) return ids.end();
  const auto place = std::ranges::lower_bound(ids, id);
  return place != ids.end() && *place == id ? place : ids.end();
}

}  // namespace

ColliderMoves::ColliderMoves(std::span<const std::uint32_t> collider_ids)
    : collider_ids_(collider_ids.begin(), collider_ids.end()), columns_(collider_ids.size()) {}

void ColliderMoves::next(const TraceFrame& trace_frame) {
  moves_.resize(trace_frame.colliders.size());  // filled in place: one that is built elsewhere and copied costs more
  std::size_t count = 0;
  IdPlace next = collider_ids_.begin();
  for (const std::uint32_t id : trace_frame.teleported) {
    const IdPlace place = place_of(collider_ids_, id, next);
    if (place == collider_ids_.end()) continue;
    columns_[static_cast<std::size_t>(place - collider_ids_.begin())].seen_in = 0;
    next = place + 1;
  }
  next = collider_ids_.begin();
  bool ascending = true;
  for (const ColliderSample& sample : trace_frame.colliders) {
    const IdPlace place = place_of(collider_ids_, sample.id, next);
    if (place == collider_ids_.end()) continue;
    next = place + 1;
    const auto column = static_cast<std::size_t>(place - collider_ids_.begin());
    Column& before = columns_[column];
    if (before.seen_in != 0 && before.seen_in == trace_frame.index) {
      ascending = ascending && (count == 0 || moves_[count - 1].column < column);
      ColliderMove& move = moves_[count++];
      move.column = static_cast<std::uint32_t>(column);
      move.owner = sample.owner;
      move.radius_m = is_sphere_radius(sample.radius_m) ? double{sample.radius_m} : 0;
      move.start_m = before.position_m;
      move.end_m = sample.position_m;
    }
    before.position_m = sample.position_m;
    before.seen_in = trace_frame.index + 1;
  }
  moves_.resize(count);
  if (!ascending) std::ranges::sort(moves_, {}, &ColliderMove::column);
}

}  // namespace vestige
