#include "analysis/live/live_columns.hpp"

#include <algorithm>

namespace vestige {

namespace {

constexpr std::size_t kFirstColumns = 256;
constexpr std::int64_t kGone_ns = 10'000'000'000;

}  // namespace

LiveColumns::LiveColumns() {
  make_room(0);
}

bool LiveColumns::number(const TraceFrame& frame, TraceFrame& out) {
  const std::size_t before = columns_.size();
  out.index = frame.index;
  out.time_ns = frame.time_ns;
  out.poses = frame.poses;
  out.colliders = frame.colliders;
  for (ColliderSample& collider : out.colliders) collider.id = column_of(collider.id, frame.time_ns);
  out.teleported.clear();
  for (const std::uint32_t id : frame.teleported)
    if (const auto place = place_of_.find(id); place != place_of_.end() && place->second.last_ns == frame.time_ns)
      out.teleported.push_back(place->second.column);
  return columns_.size() != before;
}

std::uint32_t LiveColumns::column_of(std::uint32_t id, std::int64_t time_ns) {
  if (const auto place = place_of_.find(id); place != place_of_.end()) {
    place->second.last_ns = time_ns;
    return place->second.column;
  }
  if (free_.empty()) make_room(time_ns);
  const std::uint32_t column = free_.back();
  free_.pop_back();
  place_of_[id] = {column, time_ns};
  ids_[column] = id;
  ++seen_;
  return column;
}

void LiveColumns::make_room(std::int64_t time_ns) {
  for (auto place = place_of_.begin(); place != place_of_.end();) {
    if (place->second.last_ns + kGone_ns < time_ns) {
      free_.push_back(place->second.column);
      place = place_of_.erase(place);
    } else {
      ++place;
    }
  }
  if (!free_.empty()) return;
  const std::size_t before = columns_.size();
  const std::size_t size = std::max(kFirstColumns, 2 * before);
  for (std::size_t column = before; column < size; ++column) columns_.push_back(static_cast<std::uint32_t>(column));
  ids_.resize(size);
  free_.assign(columns_.rbegin(), columns_.rend() - static_cast<std::ptrdiff_t>(before));
}

}  // namespace vestige
