#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "traces/scene/pose.hpp"

namespace vestige {

/// The `owner` of a collider that belongs to nobody. The first person of a trace is owner 1.
inline constexpr std::uint16_t kNobody = 0;

/// A collider: a sphere with an id that stays the same over the whole trace.
struct ColliderSample {
  std::uint32_t id = 0;
  glm::dvec3 position_m = glm::dvec3(0);  ///< world; of the centre
  float radius_m = 0;                     ///< 0 is a point; may change from frame to frame
  std::uint16_t owner = kNobody;  ///< the person whose limb it is, which it never touches; an id keeps its owner
};

/// kPoints: no collider of the trace has a radius. kSpheres: each may have one.
enum class ColliderShape : std::uint8_t { kPoints, kSpheres };

/// kNone: the trace's colliders belong to nobody. kPeople: each may belong to a person, as in traces of several people.
enum class Owners : std::uint8_t { kNone, kPeople };

/// Most frames of a trace, which numbers them in 32 bits.
inline constexpr double kMostTraceFrames = 4294967295.0;

/// One frame: every person, and every collider present, at `time_ns`.
struct TraceFrame {
  std::uint64_t index = 0;   ///< counts from 0 (MCAP's `sequence`)
  std::int64_t time_ns = 0;  ///< since the start of the trace, never decreasing
  /// One for each person of the trace, of whom there is at least one. A person whose pose is missing has no nodes; that
  /// happens only where a trace of several people is damaged.
  std::vector<Pose> poses = std::vector<Pose>(1);
  std::vector<ColliderSample> colliders;  ///< any order, each id at most once
  std::vector<std::uint32_t> teleported;  ///< ids that jumped here since the last frame: their segment is not tested

  double time_s() const { return static_cast<double>(time_ns) / 1e9; }
};

/// Content of the metadata record `session`: format_version, argv, commit, machine, clock, wall_start, sha256 of each
/// attachment, ….
using Session = std::map<std::string, std::string>;

}  // namespace vestige
