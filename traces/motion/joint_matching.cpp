#include "traces/motion/joint_matching.hpp"

#include <map>
#include <set>
#include <string>

namespace vestige {

namespace {

using Index = std::size_t;
using Roles = std::vector<std::optional<BodyRole>>;

class Matcher {
 public:
  Matcher(const Skeleton& motion, const Skeleton& avatar) : motion_(motion), avatar_(avatar) {
    follows_.resize(avatar.joints.size());
    taken_.resize(motion.joints.size());
    match_roles();
    match_spines();
    match_names();
  }
  const std::vector<std::optional<Index>>& follows() const { return follows_; }

 private:
  void match(Index node, Index joint) {
    if (!avatar_.usable[node] || follows_[node]) return;
    follows_[node] = joint;
    taken_[joint] = true;
  }

  void match_roles() {
    for (Index node = 0; node < avatar_.roles.size(); ++node) {
      const auto& role = avatar_.roles[node];
      if (!role || role->part == BodyPart::kSpine) continue;
      if (const auto joint = find_role(motion_, *role)) match(node, *joint);
    }
  }

  static std::vector<Index> spine_of(const Roles& roles) {
    std::map<int, Index> spine;
    for (Index i = 0; i < roles.size(); ++i)
      if (roles[i] && roles[i]->part == BodyPart::kSpine) spine.emplace(roles[i]->segment, i);
    std::vector<Index> joints;
    joints.reserve(spine.size());
    for (const auto& [segment, joint] : spine) joints.push_back(joint);
    return joints;
  }

  /// Matches the upper end of each spine bone with the bone of the other spine that ends there.
  void match_spines() {
    const std::vector<Index> motion = spine_of(motion_.roles);
    const std::vector<Index> avatar = spine_of(avatar_.roles);
    for (Index k = 0; !motion.empty() && k < avatar.size(); ++k)
      match(avatar[k], motion[((k + 1) * motion.size() + avatar.size() - 1) / avatar.size() - 1]);
  }

  /// Matches joints that are no part of a body (tails, skirts) by equal names, if neither has a role. What is above the
  /// hips keeps its place: the hips' rotation and travel count in the world.
  void match_names() {
    std::vector<bool> is_above_hips(avatar_.joints.size());
    for (auto i = find_role(avatar_, kHips); i && avatar_.joints[*i].parent >= 0;) {
      i = static_cast<Index>(avatar_.joints[*i].parent);
      is_above_hips[*i] = true;
    }
    static const std::set<std::string> anyones = {"", "root", "armature", "scene", "reference"};
    std::map<std::string, Index> by_name;
    for (Index joint = 0; joint < motion_.joints.size(); ++joint)
      if (!taken_[joint]) by_name.emplace(plain_joint_name(motion_.joints[joint].name), joint);
    for (Index node = 0; node < avatar_.joints.size(); ++node) {
      const std::string name = plain_joint_name(avatar_.joints[node].name);
      const auto same = by_name.find(name);
      if (same == by_name.end() || anyones.contains(name) || is_above_hips[node]) continue;
      if (!taken_[same->second] && !avatar_.roles[node] && !motion_.roles[same->second]) match(node, same->second);
    }
  }

  const Skeleton& motion_;
  const Skeleton& avatar_;
  std::vector<std::optional<Index>> follows_;
  std::vector<bool> taken_;
};

}  // namespace

std::vector<std::optional<std::size_t>> match_joints(const Skeleton& motion, const Skeleton& avatar) {
  return Matcher(motion, avatar).follows();
}

}  // namespace vestige
