#include "detector/approximate/moving_frame.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace vestige {

MovingFrame::MovingFrame(const SkinMatrix& matrix)
    : linear_(glm::dvec3(matrix.column[0]), glm::dvec3(matrix.column[1]), glm::dvec3(matrix.column[2])),
      offset_(matrix.column[3]),
      regular_(std::isnormal(glm::determinant(linear_))) {
  if (regular_) inverse_ = glm::inverse(linear_);
}

double MovingFrame::scale() const {
  return std::sqrt(
      (glm::dot(linear_[0], linear_[0]) + glm::dot(linear_[1], linear_[1]) + glm::dot(linear_[2], linear_[2])) / 3);
}

double MovingFrame::relative_size(const glm::dmat3& change) const {
  const glm::dmat3 relative = change * inverse_;
  return std::sqrt(glm::dot(relative[0], relative[0]) + glm::dot(relative[1], relative[1]) +
                   glm::dot(relative[2], relative[2]));
}

}  // namespace vestige
