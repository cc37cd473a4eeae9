#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/mapping/body_surface.hpp"
#include "analysis/mapping/skin_parts.hpp"

namespace vestige {

/// How an avatar's parts were told apart.
enum class Understanding {
  kJoints,      ///< by the names of its joints
  kProportions  ///< by a grown person's proportions, since its joints' names say too little
};

/// An avatar's skin with what a region may ask of it: which part of a body, and which joint, a point belongs to.
class Body {
 public:
  /// `avatar` has triangles, and must stay.
  explicit Body(const Avatar& avatar);

  const BodySurface& surface() const { return surface_; }
  const Avatar& avatar() const { return surface_.avatar(); }
  Understanding understanding() const { return understanding_; }

  /// The part whose joints weigh most. Islands of a part that lie within another (a kneecap whose weights stray to the
  /// foot) belong to what surrounds them.
  SkinPart part_at(const SkinPoint& point) const;
  /// The node that weighs most: a joint, or the node of a mesh without joints.
  int node_at(const SkinPoint& point) const;

  /// The plane between left (+x) and right.
  double middle_x_m() const { return middle_x_m_; }
  /// The heights that a vest covers: of the way from the hip joints up to the neck's, 4.5 % to 95.5 %, which on the
  /// built-in avatar are the 0.94 m and 1.45 m of its own map. Where these joints are not known, of the torso's skin.
  double vest_low_m() const { return vest_low_m_; }
  double vest_high_m() const { return vest_high_m_; }

 private:
  void weigh_parts();
  void settle_islands();
  bool is_understood() const;
  SkinPart part_by_proportions(const glm::dvec3& position_m) const;
  void find_middle();
  void find_vest();

  BodySurface surface_;
  std::vector<std::optional<SkinPart>> parts_of_nodes_;
  std::vector<std::array<float, kSkinParts>> part_weights_;  ///< of every vertex
  Understanding understanding_ = Understanding::kJoints;
  double middle_x_m_ = 0;
  double vest_low_m_ = 0;
  double vest_high_m_ = 0;
};

}  // namespace vestige
