#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "analysis/plot/studio/subject.hpp"
#include "analysis/plot/studio/surface.hpp"
#include "traces/scene/pose.hpp"

namespace vestige::plot {

/// All people at a moment, as one surface.
struct Crowd {
  Surface surface;
  glm::dvec3 origin_m = glm::dvec3(0);        ///< in the world: what the surface's places are relative to
  std::vector<std::uint32_t> first_triangle;  ///< of each person, and behind them the number of triangles

  /// Returns which person, counted from 0, a triangle of the surface belongs to.
  std::size_t person_of(std::uint32_t triangle) const;
};

/// Poses people.
class CrowdPoser {
 public:
  /// The subjects must outlive this object.
  explicit CrowdPoser(const std::vector<Subject>& subjects);

  /// Those whose pose is missing are left out.
  Crowd pose(const std::vector<Pose>& poses, const glm::dvec3& origin_m) const;

 private:
  std::vector<SurfacePoser> posers_;
};

/// Returns where the first person stands in the world whose pose is not missing. Far from the world's origin floats are
/// coarse: what is drawn should be posed relative to this place.
glm::dvec3 standing_at(const std::vector<Subject>& subjects, const std::vector<Pose>& poses);

}  // namespace vestige::plot
