#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige::plot {

/// The path of one collider without a gap or a jump. It has at least one stop. If the path ends at the moment, its last
/// two stops are the segment that is tested.
struct Path {
  struct Stop {
    double age_s = 0;  ///< time before the moment
    glm::dvec3 position_m = glm::dvec3(0);
  };
  std::uint32_t collider = 0;  ///< its id
  bool is_current = false;     ///< the collider exists at the moment
  float radius_m = 0;          ///< at its last stop; 0: a point
  std::vector<Stop> stops;     ///< oldest first; thinned out if there are many
};

/// Colliders' recent paths while a trace is read.
class Trails {
 public:
  /// `length_s`: how far back paths reach, above 0.
  explicit Trails(double length_s) : length_s_(length_s) {}

  /// Takes the next frame of the trace. Colliders whose place is not finite are left out.
  void add(const TraceFrame& frame);
  /// Returns the paths, first those that have ended. `time_s` is that of the frame taken last.
  std::vector<Path> paths(double time_s) const;

 private:
  void finish(std::uint32_t id);
  void thin(Path& trail) const;
  void forget(Path& trail, double time_s) const;

  double length_s_;
  std::map<std::uint32_t, Path> trails_;  ///< by id; until `paths`, age_s holds the time itself
  std::vector<Path> finished_;
};

}  // namespace vestige::plot
