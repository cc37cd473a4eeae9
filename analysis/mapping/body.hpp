#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/mapping/body_surface.hpp"
#include "traces/body/skin_parts.hpp"

namespace vestige {

/// How the parts of an avatar were told apart.
enum class Understanding {
  kJoints,      ///< by the names of the avatar's joints
  kProportions  ///< by an adult's proportions, since the joints' names say too little
};

/// An avatar's skin, with the part of the body and the joint that each point belongs to.
class Body {
 public:
  /// `avatar` must have triangles and must outlive this object.
  explicit Body(const Avatar& avatar);

  const BodySurface& surface() const { return surface_; }
  const Avatar& avatar() const { return surface_.avatar(); }
  Understanding understanding() const { return understanding_; }

  /// Returns the part whose joints weigh most. A small island of one part that lies within another part (for example a
  /// kneecap whose weights stray to the foot) belongs to the part around it. Under `kProportions`, returns the part by
  /// position instead.
  SkinPart part_at(const SkinPoint& point) const;
  /// Returns the node that weighs most: a joint, or the node of a mesh without joints.
  int node_at(const SkinPoint& point) const;

  /// Turns a place about +y as if the avatar faced +z: its left is then +x. `Avatar::facing` tells where it faces.
  glm::dvec3 turned(const glm::dvec3& position_m) const { return turned_to_front(position_m, avatar().facing.axis); }
  /// Returns how far to the left of the body's middle a place of the avatar is, in metres; negative: to the right.
  double leftwards_m(const glm::dvec3& position_m) const { return turned(position_m).x - middle_x_m_; }
  /// Returns the middle of the torso's skin along a horizontal direction of length 1, in metres.
  double middle_m(const glm::dvec3& direction) const;
  /// The x of the plane between left and right, of `turned` places.
  double middle_x_m() const { return middle_x_m_; }
  /// The heights between which a vest lies: 4.5 % and 95.5 % of the way from the hip joints up to the neck joint. On
  /// the built-in avatar these are 0.94 m and 1.45 m, as in the avatar's own map. Where a joint is not known, the end
  /// of the torso's skin takes its place.
  double vest_low_m() const { return vest_low_m_; }
  double vest_high_m() const { return vest_high_m_; }

 private:
  void weigh_parts();
  void settle_islands();
  bool is_understood() const;
  SkinPart part_by_proportions(const glm::dvec3& position_m) const;
  void find_vest();

  BodySurface surface_;
  std::vector<std::optional<SkinPart>> parts_of_nodes_;
  std::vector<std::array<float, kSkinParts>> part_weights_;  ///< for each vertex
  Understanding understanding_ = Understanding::kJoints;
  double middle_x_m_ = 0;
  double vest_low_m_ = 0;
  double vest_high_m_ = 0;
};

}  // namespace vestige
