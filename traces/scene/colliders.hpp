#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

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

}  // namespace vestige
