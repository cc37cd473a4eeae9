#include "transport/vmc/skin_difference.hpp"

#include <limits>

namespace vestige {

SkinDifference::SkinDifference(const Avatar& avatar) : avatar_(avatar) {
  struct Box {
    glm::dvec3 least = glm::dvec3(std::numeric_limits<double>::infinity());
    glm::dvec3 most = glm::dvec3(-std::numeric_limits<double>::infinity());
  };
  std::vector<Box> boxes(avatar.palette.size());
  for (std::size_t v = 0; v < avatar.position_bind.size(); ++v) {
    const Influences& influences = avatar.influences[v];
    for (std::size_t i = 0; i < kMaxInfluences && influences.weight[i] > 0; ++i) {
      Box& box = boxes[influences.palette[i]];
      const glm::dvec3 position(avatar.position_bind[v]);
      box.least = glm::min(box.least, position);
      box.most = glm::max(box.most, position);
    }
  }
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    if (boxes[p].least.x > boxes[p].most.x) continue;  // it moves no vertex
    Part part = {.node = static_cast<std::size_t>(avatar.palette[p].node)};
    for (unsigned corner = 0; corner < part.corners.size(); ++corner) {
      glm::dvec4 place(boxes[p].least, 1);
      for (unsigned axis = 0; axis < 3; ++axis)
        if ((corner >> axis & 1U) != 0) place[static_cast<int>(axis)] = boxes[p].most[static_cast<int>(axis)];
      part.corners[corner] = glm::dvec3(avatar.palette[p].inverse_bind * place);
    }
    parts_.push_back(part);
  }
}

SkinDifference::Bound SkinDifference::between(const Pose& a, const Pose& b) {
  world_matrices(avatar_, a, world_a_);
  world_matrices(avatar_, b, world_b_);
  Bound bound;
  for (const Part& part : parts_) {
    const glm::dmat4 difference = world_a_[part.node] - world_b_[part.node];
    for (const glm::dvec3& corner : part.corners) {
      // Both matrices end with 1, and their difference with 0.
      const glm::dvec3 moved = glm::dvec3(difference * glm::dvec4(corner, 1)) + (a.origin_m - b.origin_m);
      if (const double length_m = glm::length(moved); length_m > bound.most_m) bound = {length_m, part.node};
    }
  }
  return bound;
}

}  // namespace vestige
