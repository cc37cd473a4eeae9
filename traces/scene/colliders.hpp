#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

struct TimeSpan {
  double first_s = 0;
  double last_s = std::numeric_limits<double>::infinity();
};

/// The positions of colliders over time, from a built-in scenario or a file.
class ColliderSource {
 public:
  ColliderSource() = default;
  virtual ~ColliderSource() = default;
  ColliderSource(const ColliderSource&) = delete;
  ColliderSource& operator=(const ColliderSource&) = delete;

  /// Returns in `out` the colliders present at `time_s`, relative to the scene's origin. Times must not decrease
  /// between calls.
  virtual void sample(double time_s, std::vector<ColliderSample>& out) = 0;

  /// Whether the colliders may have a radius.
  virtual ColliderShape shape() const { return ColliderShape::kPoints; }

  /// Whether the colliders may belong to people. An id keeps its owner.
  virtual Owners owners() const { return Owners::kNone; }

  /// The ids of colliders that jumped to their position in the last `sample`. Their path is not a line segment and must
  /// not be tested.
  const std::vector<std::uint32_t>& teleported() const { return teleported_; }

  /// The largest id of the colliders of a file. A scenario has none: it numbers its colliders from 0 on.
  virtual std::optional<std::uint32_t> largest_id() const { return {}; }

  /// First and last time of the samples. A scenario has no bounds.
  virtual TimeSpan span_s() const { return {}; }

  /// The median time between two samples of a collider. 0 if the source has none.
  virtual double median_step_s() const { return 0; }

  /// Reasons why fewer colliders or contacts than expected may appear, one sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }

 protected:
  std::vector<std::uint32_t> teleported_;
};

/// Returns the same colliders, each with this radius in every frame. 0: points.
std::unique_ptr<ColliderSource> with_radius(std::unique_ptr<ColliderSource> source, float radius_m);

}  // namespace vestige
