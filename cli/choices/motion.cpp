#include "cli/choices/motion.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/help/suggest.hpp"
#include "traces/base/error.hpp"
#include "traces/motion/animation_choice.hpp"

namespace vestige::cli {

namespace {

/// What tells the direction that is up: in JSON, and in words.
const std::map<UpAxis::By, std::pair<const char*, const char*>> kUpBy = {
    {UpAxis::By::kGround, {"floor", "by its floor"}},
    {UpAxis::By::kRest, {"rest", "as at rest"}},
    {UpAxis::By::kAssumed, {"assumed", "which nothing tells"}},
    {UpAxis::By::kAsked, {"flag", "as asked"}}};

void say_what_matched(const RetargetReport& report, const std::string& path, Verbosity verbosity) {
  warn_of_names(path, "nothing follows these joints", report.unmatched_joints, verbosity);
  warn_of_names(path, "these joints of the avatar keep their rest pose", report.unmatched_nodes, verbosity);
  if (verbosity != Verbosity::kVerbose) return;
  for (const JointMatch& match : report.matched)
    warn_of_names(path, fmt::format("{} moves", shown_word(match.joint)), {match.node}, verbosity);
}

/// Returns "+y", "-z", ….
std::string axis_name(const glm::dvec3& direction) {
  for (int axis = 0; axis < 3; ++axis)
    if (direction[axis] != 0) return {direction[axis] > 0 ? '+' : '-', static_cast<char>('x' + axis)};
  return "";
}

void say_what_differs(const RetargetReport& report, const std::string& path, Verbosity verbosity) {
  if (report.up.by == UpAxis::By::kAssumed)
    warn(fmt::format("{}: nothing tells which axis is up; {} is taken; --up sets it", path, axis_name(report.up.up)),
         verbosity);
  for (const Deviation& deviation : report.deviations)
    warn(fmt::format("{}: {}: the avatar's direction differs by up to {:.0f} degrees from the motion's (frame {})",
                     path, deviation.what, deviation.degrees, deviation.frame),
         verbosity);
}

/// Returns how many metres the unit has; nothing for "auto".
std::optional<double> metres_of_unit(const std::string& unit) {
  static const std::map<std::string, double> metres = {{"mm", 0.001}, {"cm", 0.01}, {"inch", 0.0254}, {"m", 1.0}};
  const auto known = metres.find(unit);
  return known == metres.end() ? std::nullopt : std::optional(known->second);
}

/// Returns the direction "y", "-z", …; nothing for "auto".
std::optional<glm::dvec3> direction_of(const std::string& axis) {
  if (axis == "auto") return {};
  glm::dvec3 direction(0);
  direction[axis.back() - 'x'] = axis.front() == '-' ? -1 : 1;
  return direction;
}

}  // namespace

void warn_of_names(const std::string& path, std::string_view what, const std::vector<std::string>& names,
                   Verbosity verbosity) {
  if (names.empty()) return;
  std::vector<std::string> shown;
  shown.reserve(names.size());
  for (const std::string& name : names) shown.push_back(shown_word(name));
  warn(fmt::format("{}: {}: {}", path, what, fmt::join(shown, ", ")), verbosity);
}

void add_motion_options(CLI::App& verb, MotionChoice& choice) {
  verb.add_option("--unit", choice.unit,
                  "How far the motion capture travels: auto scales it by the legs of both bodies, so that feet do not "
                  "slide; a unit keeps true distances. Colliders have --collider-unit")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "mm", "cm", "inch", "m"}));
  verb.add_option("--up", choice.up,
                  "Which axis of the motion capture is up: auto finds it by its floor; negative axes as --up=-z")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "y", "z", "-y", "-z"}));
}

namespace {

/// As `find_animation`, and a name that the avatar does not have gets what was probably meant.
const Animation* find_named(const Avatar& avatar, const std::string& name_or_index) {
  try {
    return find_animation(avatar, name_or_index);
  } catch (const UsageError& error) {
    std::vector<std::string_view> names = {"none"};
    names.reserve(avatar.animations.size() + 1);
    for (const Animation& animation : avatar.animations) names.push_back(animation.name);
    throw UsageError("--animation", fmt::format("there is no animation '{}'", name_or_index),
                     help::did_you_mean(name_or_index, names) + std::string(error.remedy()));
  }
}

}  // namespace

CLI::Option* add_morph_option(CLI::App& verb, MorphChoice& choice) {
  return verb.add_flag(
      "--ignore-morphs", choice.ignored,
      "Play an animation that also moves the skin by morph targets (a face, breathing): this motion is left "
      "out, with a warning that says how far it goes");
}

const Animation* choose_animation(const Avatar& avatar, const std::string& name_or_index, const MorphChoice& morphs,
                                  Verbosity verbosity) {
  const Animation* animation = find_named(avatar, name_or_index);
  if (animation == nullptr || !animation->morph) return animation;
  const std::string cause = describe_morph(*animation);
  if (!morphs.ignored)
    throw Error(animation->morph->where, cause + ", which cannot be played",
                "add --ignore-morphs to leave this motion out, or choose another --animation");
  warn(fmt::format("{}: {}; this motion is left out", animation->morph->where, cause), verbosity);
  return animation;
}

LoadedMotion add_motion(Avatar& avatar, const std::string& path, const MotionChoice& choice,
                        const std::vector<std::string>& outputs, const CommonOptions& common) {
  const Verbosity verbosity = common.verbosity();
  const BvhMotion motion = read_bvh(path);
  for (const std::string& warning : motion.warnings) warn(warning, verbosity);
  LoadedMotion loaded = {motion.frame_time_s, motion.frame_count, motion.joints.size(), {}};
  const RetargetOptions options = {metres_of_unit(choice.unit), direction_of(choice.up),
                                   refusal_unless_forced(outputs, common, "accept a body that leans")};
  Animation animation;
  try {
    animation = retarget(motion, avatar, options, path, loaded.report);
  } catch (const Error&) {
    say_what_matched(loaded.report, path, verbosity);  // the cause may be there
    throw;
  }
  animation.name = path;
  avatar.animations.push_back(std::move(animation));
  say_what_matched(loaded.report, path, verbosity);
  say_what_differs(loaded.report, path, verbosity);
  return loaded;
}

std::string describe(const LoadedMotion& motion) {
  const RetargetReport& report = motion.report;
  const std::string tall = fmt::format("the skeleton is {:.4g} units tall", report.height);
  return fmt::format("{} nodes follow {} of {} joints; {}{}; 1 unit is {:.4g} m here; {} is up, {}\n",
                     report.matched.size(), motion.joint_count - report.unmatched_joints.size(), motion.joint_count,
                     tall,
                     report.likely_unit.empty() ? ", which is a person's height in no usual unit"
                                                : fmt::format(", likely {}", report.likely_unit),
                     report.metres_per_unit, axis_name(report.up.up), kUpBy.at(report.up.by).second);
}

nlohmann::ordered_json to_json(const LoadedMotion& motion) {
  const RetargetReport& report = motion.report;
  nlohmann::ordered_json matched = nlohmann::ordered_json::array();
  for (const JointMatch& match : report.matched)
    matched.push_back(
        {{"joint", match.joint}, {"node", match.node}, {"by", match.how == JointMatch::How::kName ? "name" : "role"}});
  nlohmann::ordered_json deviations = nlohmann::ordered_json::array();
  for (const Deviation& deviation : report.deviations)
    deviations.push_back({{"what", deviation.what}, {"degrees", deviation.degrees}, {"frame", deviation.frame}});
  return {{"frames", motion.frame_count},
          {"frame_time_s", motion.frame_time_s},
          {"matched", matched},
          {"unmatched_joints", report.unmatched_joints},
          {"unmatched_nodes", report.unmatched_nodes},
          {"height", report.height},
          {"likely_unit", report.likely_unit},
          {"metres_per_unit", report.metres_per_unit},
          {"up", axis_name(report.up.up)},
          {"up_by", kUpBy.at(report.up.by).first},
          {"deviations", deviations}};
}

}  // namespace vestige::cli
