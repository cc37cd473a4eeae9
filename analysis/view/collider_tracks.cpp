#include "analysis/view/collider_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace vestige {

namespace {

std::int32_t in_units(double length_m) {
  return static_cast<std::int32_t>(std::lround(length_m / kPageUnit_m));
}

bool within_reach(const glm::dvec4& place) {
  for (int axis = 0; axis < 4; ++axis)
    if (!(std::abs(place[axis]) < kPageReach_m)) return false;  // nor NaN
  return true;
}

}  // namespace

ColliderTracks::ColliderTracks(std::span<const std::uint32_t> ids)
    : ids_(ids.begin(), ids.end()), tracks_(ids.size()) {}

void ColliderTracks::add(const PageRow& at, const TraceFrame& frame, const glm::dvec3& origin_m) {
  std::vector<std::uint32_t> jumped = frame.teleported;
  std::ranges::sort(jumped);
  for (const ColliderSample& collider : frame.colliders) {
    const auto found = std::ranges::lower_bound(ids_, collider.id);
    if (found == ids_.end() || *found != collider.id) continue;
    const Sample sample = {at, glm::dvec4(collider.position_m - origin_m, collider.radius_m)};
    if (!within_reach(sample.place)) {
      ++left_out_;
      continue;
    }
    Track& track = tracks_[static_cast<std::size_t>(found - ids_.begin())];
    const bool goes_on = !track.keys.empty() && track.last.at.index + 1 == at.index &&
                         track.last.at.time_s < at.time_s && !std::ranges::binary_search(jumped, collider.id);
    if (goes_on) {
      extend(track, sample);
    } else {
      end(track);
      keep(track, sample, true);
    }
    track.last = sample;
  }
}

void ColliderTracks::keep(Track& track, const Sample& sample, bool begins) {
  Key key = {.row = sample.at.row, .begins = begins};
  for (std::size_t axis = 0; axis < 4; ++axis) key.place[axis] = in_units(sample.place[static_cast<int>(axis)]);
  track.keys.push_back(key);
  track.anchor = sample;
  track.low = glm::dvec4(-std::numeric_limits<double>::infinity());
  track.high = glm::dvec4(std::numeric_limits<double>::infinity());
}

void ColliderTracks::extend(Track& track, const Sample& sample) {
  const auto velocity = [&](double more_m) {
    return (sample.place - track.anchor.place + more_m) / (sample.at.time_s - track.anchor.at.time_s);
  };
  const glm::dvec4 straight = velocity(0);
  if (glm::any(glm::lessThan(straight, track.low)) || glm::any(glm::greaterThan(straight, track.high)))
    keep(track, track.last, false);
  track.low = glm::max(track.low, velocity(-kTolerance_m));
  track.high = glm::min(track.high, velocity(kTolerance_m));
}

void ColliderTracks::end(Track& track) {
  if (!track.keys.empty() && track.keys.back().row != track.last.at.row) keep(track, track.last, false);
}

void ColliderTracks::finish(PageArrays& arrays) {
  std::vector<std::uint32_t> first = {0};
  std::vector<std::uint32_t> rows;
  std::vector<std::int32_t> positions;
  std::vector<std::int32_t> radii;
  std::vector<std::uint8_t> begins;
  for (Track& track : tracks_) {
    end(track);
    for (const Key& key : track.keys) {
      rows.push_back(key.row);
      positions.insert(positions.end(), key.place.begin(), key.place.begin() + 3);
      radii.push_back(key.place[3]);
      begins.push_back(key.begins ? 1 : 0);
    }
    first.push_back(static_cast<std::uint32_t>(rows.size()));
  }
  arrays.add("collider_id", ids_, 1);
  arrays.add("track_first", first, 1);
  arrays.add("key_row", rows, 1);
  arrays.add("key_position", positions, 3);
  arrays.add("key_radius", radii, 1);
  arrays.add("key_begins", begins);
}

}  // namespace vestige
