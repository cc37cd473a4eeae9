#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

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

  /// Those that jumped to where the last `sample` found them: no segment leads there.
  const std::vector<std::uint32_t>& teleported() const { return teleported_; }

  /// When there are samples: first and last time. A scenario has no bounds.
  virtual TimeSpan span_s() const { return {}; }

  /// Why there may be less to see than expected, one sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }

 protected:
  std::vector<std::uint32_t> teleported_;
};

struct ScenarioSettings {
  std::uint32_t count = 100;
  std::uint64_t seed = 1;
};

/// A built-in scenario. The same avatar, animation, count and seed give the same positions at the same times, at any
/// rate of sampling.
struct Scenario {
  std::string_view name;
  std::string_view summary;  ///< one line
  std::uint32_t default_count;
  /// `animation` may be null: then the avatar rests.
  std::unique_ptr<ColliderSource> (*make)(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings);
};

/// All of them, in the order in which to list them.
std::span<const Scenario> scenarios();

/// Null where none has this name.
const Scenario* find_scenario(std::string_view name);

/// Reads `time_s,id,x,y,z` (that header, then a row for each sample, metres; times not decreasing). Between two samples
/// of a collider its position is interpolated linearly; before its first and after its last it is absent. With the
/// header `frame,time_s,id,x,y,z,teleported` that a trace is exported with, it is absent too over frames that it misses
/// and on the way to where it teleported. Throws `Error` as `ColliderRows` does, for two positions at one time and for
/// a file without rows.
std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path);

/// Colliders that are nodes of a glTF file, where its animations (all of them, from time 0) move them in the world.
/// They are absent while their scale is 0 and after the last key. `pattern` chooses nodes by name, as a shell does
/// (`*`, `?`,
/// `[…]`); empty: those named "collider…", or else every node whose translation is animated and that is no joint of a
/// skin. A node's id is the number that its name ends in, where all have one and none twice; else they are counted in
/// the file's order. Throws `Error` for what is no glTF and where no node is chosen, naming those there are.
std::unique_ptr<ColliderSource> read_collider_gltf(const std::filesystem::path& path, const std::string& pattern);

}  // namespace vestige
