#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "detector/skinning.hpp"

namespace vestige {

/// The affine motion from a joint's bind space to the world, and back, in double.
class MovingFrame {
 public:
  explicit MovingFrame(const SkinMatrix& matrix);

  /// False if the joint is scaled to nothing: then nothing can be moved back.
  bool is_regular() const { return regular_; }
  const glm::dmat3& linear() const { return linear_; }
  glm::dvec3 to_world(const glm::dvec3& bind) const { return linear_ * bind + offset_; }
  glm::dvec3 to_bind(const glm::dvec3& world) const { return inverse_ * (world - offset_); }
  /// Returns how much longer lengths are in the world: the root mean square over all directions.
  double scale() const;
  /// Returns the vector, in the world, whose product with a displacement is that of `normal` with it in bind space.
  glm::dvec3 normal_to_world(const glm::dvec3& normal) const { return normal * inverse_; }
  /// Returns at least the largest |change x| / |linear() x| over all x.
  double relative_size(const glm::dmat3& change) const;

 private:
  glm::dmat3 linear_;
  glm::dvec3 offset_;
  glm::dmat3 inverse_ = glm::dmat3(1);
  bool regular_;
};

}  // namespace vestige
