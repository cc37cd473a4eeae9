#include "analysis/run/skinning_error.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "traces/scene/box.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

void SkinningError::add(const Avatar& avatar, const Pose& pose, const DetectorFrame& frame, Detector& detector) {
  std::vector<glm::dvec3> reference;
  std::vector<glm::vec3> own;
  std::vector<glm::vec3> contract;
  skin_reference(avatar, pose, frame.origin_m, reference);
  detector.skinned_vertices(frame, own);
  skin_vertices(avatar, frame.palette, contract);
  if (detector.skins_in_shader() && !identical) identical = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    largest_m = std::max(largest_m, glm::distance(glm::dvec3(own[i]), reference[i]));
    largest_cpu_m = std::max(largest_cpu_m, glm::distance(glm::dvec3(contract[i]), reference[i]));
    if (identical && own[i] == contract[i]) ++*identical;
  }
  vertices += reference.size();
  ++frames;
  height_m = std::max(height_m, box_around(reference).longest_side());
}

SkinningError& SkinningError::operator+=(const SkinningError& other) {
  frames += other.frames;
  vertices += other.vertices;
  if (other.identical) identical = identical.value_or(0) + *other.identical;
  largest_m = std::max(largest_m, other.largest_m);
  largest_cpu_m = std::max(largest_cpu_m, other.largest_cpu_m);
  height_m = std::max(height_m, other.height_m);
  return *this;
}

}  // namespace vestige
