#include "traces/motion/retarget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/motion/compare_directions.hpp"
#include "traces/motion/retargeter.hpp"
#include "traces/motion/skeleton.hpp"

namespace vestige {

namespace {

using Index = std::size_t;

// Left hand and right hand must not change sides.
constexpr double kHandTolerance_deg = 90;

// The limit of a glTF animation, too: half an hour of 60 joints at 120 Hz. A file may also give only one number a frame
// for all of its joints. So beyond some minutes, at most eight numbers are stored for each number in the file.
constexpr std::size_t kMostNumbers = std::size_t{1} << 26;
constexpr std::size_t kAlwaysAllowed = std::size_t{1} << 22;
constexpr std::size_t kMostGrowth = 8;

std::string likely_unit(double height) {
  constexpr double kTall_m = 1.7;
  constexpr double kMostFactor = 1.3;
  struct Unit {
    const char* name;
    double metres;
  };
  for (const Unit& unit : {Unit{"m", 1}, {"dm", 0.1}, {"inch", 0.0254}, {"cm", 0.01}, {"mm", 0.001}}) {
    const double ratio = height * unit.metres / kTall_m;
    if (ratio > 1 / kMostFactor && ratio < kMostFactor) return unit.name;
  }
  return {};
}

}  // namespace

void Retargeter::report(RetargetReport& report) const {
  std::vector<std::vector<Index>> followers(source_.joints.size());
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node]) followers[*follows_[node]].push_back(node);
  for (Index joint = 0; joint < followers.size(); ++joint) {
    const std::string& name = source_.joints[joint].name;
    if (followers[joint].empty()) report.unmatched_joints.push_back(name);
    for (const Index node : followers[joint]) {
      const std::string& node_name = target_.joints[node].name;
      const bool same = plain_joint_name(name) == plain_joint_name(node_name);
      report.matched.push_back({name, node_name, same ? JointMatch::How::kName : JointMatch::How::kRole});
    }
  }
  std::set<int> moving;
  for (const PaletteEntry& entry : avatar_.palette) moving.insert(entry.node);
  for (Index node = 0; node < follows_.size(); ++node)
    if (!follows_[node] && moving.contains(avatar_.node_order[node]))
      report.unmatched_nodes.push_back(target_.joints[node].name);
  report.height = height();
  report.likely_unit = likely_unit(report.height);
  report.up = up_;
  report.metres_per_unit = metres_per_unit_;
}

/// Returns the height of the motion's skeleton: at rest, or the lengths of its bones from the feet to the head.
double Retargeter::height() const {
  if (!rests_as_person_) {
    double sum = leg_length(source_);
    const Index hips = *follows_[*followed(kHips)];
    for (auto i = find_role(source_, {BodyPart::kHead, BodySide::kNone, 0}); i && *i != hips;) {
      const int parent = source_.joints[*i].parent;
      if (parent < 0) break;
      sum += glm::length(source_.position[*i] - source_.position[static_cast<Index>(parent)]);
      i = static_cast<Index>(parent);
    }
    return sum;
  }
  const glm::dvec3 up = glm::transpose(body_to_avatar_) * kUp;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (Index i = 0; i < source_.position.size(); ++i)
    for (const glm::dvec3& end : {source_.position[i], source_.position[i] + motion_.ends[i]}) {
      lowest = std::min(lowest, glm::dot(end, up));
      highest = std::max(highest, glm::dot(end, up));
    }
  return highest - lowest;
}

/// Returns the height of the motion's hips while its body stands as the avatar does at rest. Files count it from the
/// floor or from the rest pose; the floor on which the motion happens says which. If neither fits, the lowest joint is
/// on that floor.
double Retargeter::reference_height() const {
  constexpr double kFits = 0.05;     // share of the height of the hips
  constexpr double kOverZero = 0.2;  // share of it: the lowest joint of a body on a floor at 0
  const Index hips = *followed(kHips);
  const double floor = floor_level(motion_, body(), samples_, up_.up);
  const auto is_zero = [&](double standing) { return floor > -kFits * standing && floor < kOverZero * standing; };
  if (rests_as_person_) {
    const glm::dvec3 up = glm::transpose(body_to_avatar_) * kUp;
    const double at_rest = glm::dot(source_.position[*follows_[hips]], up);
    double lowest = at_rest;
    for (const Index joint : body())
      lowest = std::min(
          {lowest, glm::dot(source_.position[joint], up), glm::dot(source_.position[joint] + motion_.ends[joint], up)});
    const double standing = at_rest - lowest;
    const double by_floor = floor + standing;
    const auto distance = [&](double candidate) { return std::abs(candidate - by_floor); };
    const double above_zero = distance(at_rest) < distance(standing) ? at_rest : standing;
    if (is_zero(standing)) return above_zero;
    return distance(0) < kFits * standing ? 0 : by_floor;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node] && target_.roles[node]) lowest = std::min(lowest, glm::dot(target_.position[node], kUp));
  const bool have_legs = leg_length(source_) > 0 && leg_length(target_) > 0;
  const double legs = have_legs ? leg_length(source_) / leg_length(target_) : 1 / metres_per_unit_;
  const double hips_height = glm::dot(target_.position[hips], kUp);
  const double standing = (hips_height - lowest) * legs;
  return is_zero(standing) && lowest >= 0 ? hips_height * legs : floor + standing;
}

/// Counts the numbers that `animate` stores: a time with each rotation, and with the hips' position.
void Retargeter::refuse_too_many_numbers() const {
  const auto followers =
      static_cast<Index>(std::ranges::count_if(follows_, [](const auto& joint) { return joint.has_value(); }));
  const std::size_t numbers = motion_.frame_count * (followers * 5 + 4);
  const std::size_t most = std::min(kMostNumbers, kAlwaysAllowed + kMostGrowth * motion_.values.size());
  if (numbers > most)
    throw Error(
        name_,
        fmt::format("its {} frames become {} numbers for the {} joints of the avatar that follow it, more than {}",
                    motion_.frame_count, numbers, followers, most),
        "cut the motion into parts, or export it with fewer frames a second");
}

Animation Retargeter::animate() const {
  refuse_too_many_numbers();
  Animation animation;
  std::vector<float> times_s;
  for (std::size_t frame = 0; frame < motion_.frame_count; ++frame) {
    times_s.push_back(static_cast<float>(static_cast<double>(frame) * motion_.frame_time_s));
    if (frame > 0 && !(times_s[frame] > times_s[frame - 1]))
      throw Error(name_, fmt::format("the time of frame {} rounds to that of the frame before", frame),
                  "cut the motion into parts");
  }
  const Index hips = *followed(kHips);
  std::vector<std::optional<Index>> channel_of(target_.joints.size());
  const auto add = [&](Index node, AnimatedProperty property) {
    AnimationChannel channel;
    channel.node = avatar_.node_order[node];
    channel.property = property;
    channel.times_s = times_s;
    channel.values.reserve(motion_.frame_count * (property == AnimatedProperty::kRotation ? 4 : 3));
    animation.channels.push_back(std::move(channel));
    return animation.channels.size() - 1;
  };
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node]) channel_of[node] = add(node, AnimatedProperty::kRotation);
  const Index travel = add(hips, AnimatedProperty::kTranslation);

  const glm::dquat turn_to_avatar = glm::normalize(glm::quat_cast(to_avatar_));
  const glm::dquat turn_back = glm::conjugate(glm::normalize(glm::quat_cast(body_to_avatar_)));
  const glm::dvec3 hips_at_rest = target_.position[hips];
  const int above_hips = target_.joints[hips].parent;
  const glm::dmat4 into_parent =
      above_hips < 0 ? glm::dmat4(1)
                     : glm::inverse(rest_[static_cast<Index>(avatar_.node_order[static_cast<Index>(above_hips)])]);
  const double reference = reference_height();
  std::vector<BvhPlace> places;
  std::vector<glm::dquat> world(target_.joints.size());
  glm::dvec3 start(0);
  for (std::size_t frame = 0; frame < motion_.frame_count; ++frame) {
    bvh_places(motion_, frame, places);
    for (Index node = 0; node < follows_.size(); ++node) {
      const int parent = target_.joints[node].parent;
      const glm::dquat above = parent < 0 ? glm::dquat(1, 0, 0, 0) : world[static_cast<Index>(parent)];
      if (!follows_[node]) {
        const Node& resting = avatar_.nodes[static_cast<Index>(avatar_.node_order[node])];
        world[node] = resting.fixed_matrix ? above * rotation_of(*resting.fixed_matrix)
                                           : above * glm::normalize(glm::dquat(resting.rest.rotation));
        continue;
      }
      world[node] = turn_to_avatar * places[*follows_[node]].rotation * turn_back * at_rest_[node];
      const glm::quat local(glm::normalize(glm::conjugate(above) * world[node]));
      std::vector<float>& values = animation.channels[*channel_of[node]].values;
      values.insert(values.end(), {local.x, local.y, local.z, local.w});
    }
    const glm::dvec3 position = places[*follows_[hips]].position;
    if (frame == 0) start = position + (reference - glm::dot(position, up_.up)) * up_.up;
    const glm::dvec3 wanted = hips_at_rest + metres_per_unit_ * (to_avatar_ * (position - start));
    const glm::vec3 local(into_parent * glm::dvec4(wanted, 1));
    std::vector<float>& values = animation.channels[travel].values;
    values.insert(values.end(), {local.x, local.y, local.z});
    if (!std::isfinite(local.x) || !std::isfinite(local.y) || !std::isfinite(local.z))
      throw Error(name_, fmt::format("frame {}: the hips are too far away", frame), "check --unit");
  }
  animation.duration_s = double{times_s.back()};
  return animation;
}

std::vector<Deviation> Retargeter::deviations(const Animation& animation,
                                              const std::optional<std::string>& refusal) const {
  std::vector<ComparedDirection> compared;
  const auto add = [&](Index from, Index to, std::string what, double tolerance_deg) {
    compared.push_back({what.empty() ? fmt::format("{} to {}", shown_word(source_.joints[*follows_[from]].name),
                                                   shown_word(source_.joints[*follows_[to]].name))
                                     : std::move(what),
                        {*follows_[from], *follows_[to]},
                        {static_cast<Index>(avatar_.node_order[from]), static_cast<Index>(avatar_.node_order[to])},
                        tolerance_deg});
  };
  for (const auto& [from, to] : aligned_) add(from, to, "", kBoneTolerance_deg);
  const auto add_pair = [&](BodyPart part, const char* what, double tolerance_deg) {
    const auto left = followed({part, BodySide::kLeft, 0});
    const auto right = followed({part, BodySide::kRight, 0});
    if (left && right) add(*right, *left, what, tolerance_deg);
  };
  add_pair(BodyPart::kUpperLeg, "right hip to left hip", 3 * kBoneTolerance_deg);
  add_pair(BodyPart::kHand, "right hand to left hand", kHandTolerance_deg);
  const auto head = followed({BodyPart::kHead, BodySide::kNone, 0});
  const std::string body = "hips to head";
  if (head) add(*followed(kHips), *head, body, 3 * kBoneTolerance_deg);
  std::vector<Deviation> found = compare_directions(motion_, avatar_, animation, to_avatar_, compared);
  const auto leaning = std::ranges::find(found, body, &Deviation::what);
  if (refusal && leaning != found.end() && leaning->degrees > kBodyTolerance_deg)
    throw Error(name_,
                fmt::format("frame {}: from hips to head, the avatar points {:.0f} degrees away from the motion",
                            leaning->frame, leaning->degrees),
                fmt::format("check the joints that match (--verbose names them); to accept this lean, {}", *refusal));
  return found;
}

Animation retarget(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options,
                   const std::string& name, RetargetReport& report) {
  const Retargeter retargeter(motion, avatar, options, name);
  report = {};
  retargeter.report(report);
  Animation animation = retargeter.animate();
  report.deviations = retargeter.deviations(animation, options.refusal);
  return animation;
}

}  // namespace vestige
