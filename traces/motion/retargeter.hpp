#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traces/body/body_roles.hpp"
#include "traces/motion/retarget.hpp"
#include "traces/motion/skeleton.hpp"

namespace vestige {

/// The avatar's up, as in glTF.
inline constexpr glm::dvec3 kUp(0, 1, 0);

/// Aligns a motion's skeleton with the avatar's (retarget_alignment.cpp), then moves the avatar frame by frame
/// (retarget.cpp). Keeps references to what it is given.
class Retargeter {
 public:
  Retargeter(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options, const std::string& name);

  void report(RetargetReport& report) const;
  Animation animate() const;
  std::vector<Deviation> deviations(const Animation& animation, const std::optional<std::string>& refusal) const;

 private:
  using Index = std::size_t;

  void refuse_other_bodies() const;
  void refuse_too_many_numbers() const;
  void find_axes(const std::optional<glm::dvec3>& up);
  void align();
  void align_by_frames();
  glm::dquat hips_by_frames() const;
  std::optional<Index> bone_end(Index node) const;
  glm::dquat mean_turn(Index joint, Index reference) const;
  glm::dvec3 mean_direction(Index joint, Index from, Index to) const;
  glm::dquat flatter(Index foot, const glm::dquat& with_leg) const;
  /// Returns the avatar's joint with this role, if it follows a joint of the motion.
  std::optional<Index> followed(const BodyRole& role) const {
    const auto node = find_role(target_, role);
    return node && follows_[*node] ? node : std::nullopt;
  }
  glm::dquat rest_rotation(Index node) const {
    return rotation_of(rest_[static_cast<Index>(avatar_.node_order[node])]);
  }
  std::vector<Index> body() const;
  double height() const;
  double ratio_of_legs() const;
  double reference_height() const;

  const BvhMotion& motion_;
  const Avatar& avatar_;
  const std::string& name_;
  MotionSamples samples_;
  Skeleton source_;
  Skeleton target_;
  std::vector<glm::dmat4> rest_;               ///< world matrices of the avatar's nodes at rest, by node index
  std::vector<std::optional<Index>> follows_;  ///< for each joint of `target_` one of `source_`
  bool rests_as_person_ = false;
  UpAxis up_;
  glm::dmat3 to_avatar_ = glm::dmat3(1);       ///< from the axes of the motion's world to the avatar's
  glm::dmat3 body_to_avatar_ = glm::dmat3(1);  ///< the same of the skeletons at rest, if the motion's rests as a person
  double metres_per_unit_ = 0;
  std::vector<glm::dquat> at_rest_;               ///< for each of `target_`: its rotation while its joint's is zero
  std::vector<std::pair<Index, Index>> aligned_;  ///< bones of `target_` that point where the motion's do
};

}  // namespace vestige
