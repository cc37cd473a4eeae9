#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "traces/avatar.hpp"
#include "traces/trace.hpp"

namespace vestige {

struct TimeSpan {
  double first_s = 0;
  double last_s = std::numeric_limits<double>::infinity();
};

/// Where colliders are over time: a built-in scenario or a file.
class ColliderSource {
 public:
  ColliderSource() = default;
  virtual ~ColliderSource() = default;
  ColliderSource(const ColliderSource&) = delete;
  ColliderSource& operator=(const ColliderSource&) = delete;

  /// The colliders present at `time_s`, relative to the scene's origin. Times must not decrease.
  virtual void sample(double time_s, std::vector<ColliderSample>& out) = 0;

  /// When there are samples: first and last time. A scenario has no bounds.
  virtual TimeSpan span_s() const { return {}; }
};

/// `animation` may be null: then the avatar rests.
struct ScenarioSettings {
  std::uint32_t count = 100;
  std::uint64_t seed = 1;
};

/// `swarm`: points that fly straight through the body from all sides while it moves, each aimed at a random vertex
/// where that vertex will be; a new aim follows every passage. Positions lie on a grid of 2^-20 m.
std::unique_ptr<ColliderSource> make_swarm(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);

/// Reads `time_s,id,x,y,z` (that header, then a row for each sample, metres; times not decreasing). Between two samples
/// of a collider its position is interpolated linearly; before its first and after its last it is absent. Throws
/// `Error` naming file and line: wrong header, wrong number of columns, no number, not finite, time running backwards,
/// no row.
std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path);

}  // namespace vestige
