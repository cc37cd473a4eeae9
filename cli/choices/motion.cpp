#include "cli/choices/motion.hpp"

#include <fmt/format.h>

#include <map>

#include "traces/base/error.hpp"
#include "traces/motion/animation_choice.hpp"

namespace vestige::cli {

namespace {

void say_what_matched(const RetargetReport& report, const std::string& path, Verbosity verbosity) {
  warn_of_names(path, "nothing follows these joints", report.unmatched_joints, verbosity);
  warn_of_names(path, "these joints of the avatar keep their rest pose", report.unmatched_nodes, verbosity);
  if (verbosity != Verbosity::kVerbose) return;
  for (const JointMatch& match : report.matched)
    warn_of_names(path, fmt::format("{} moves", shown_word(match.joint)), {match.node}, verbosity);
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

void add_unit_option(CLI::App& verb, std::string& unit) {
  verb.add_option("--unit", unit,
                  "How far the motion capture travels: auto scales it by the heights of both hips, so that feet do not "
                  "slide; a unit keeps true distances")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "mm", "cm", "inch", "m"}));
}

CLI::Option* add_morph_option(CLI::App& verb, MorphChoice& choice) {
  return verb.add_flag(
      "--ignore-morphs", choice.ignored,
      "Play an animation that also moves the skin by morph targets (a face, breathing): this motion is left "
      "out, with a warning that says how far it goes");
}

const Animation* choose_animation(const Avatar& avatar, const std::string& name_or_index, const MorphChoice& morphs,
                                  Verbosity verbosity) {
  const Animation* animation = find_animation(avatar, name_or_index);
  if (animation == nullptr || !animation->morph) return animation;
  const std::string cause = describe_morph(*animation);
  if (!morphs.ignored)
    throw Error(animation->morph->where, cause + ", which cannot be played",
                "add --ignore-morphs to leave this motion out, or choose another --animation");
  warn(fmt::format("{}: {}; this motion is left out", animation->morph->where, cause), verbosity);
  return animation;
}

std::optional<double> metres_of_unit(const std::string& unit) {
  static const std::map<std::string, double> metres = {{"mm", 0.001}, {"cm", 0.01}, {"inch", 0.0254}, {"m", 1.0}};
  const auto known = metres.find(unit);
  return known == metres.end() ? std::nullopt : std::optional(known->second);
}

LoadedMotion add_motion(Avatar& avatar, const std::string& path, const std::string& unit, Verbosity verbosity) {
  const BvhMotion motion = read_bvh(path);
  for (const std::string& warning : motion.warnings) warn(warning, verbosity);
  LoadedMotion loaded = {motion.frame_time_s, motion.frame_count, motion.joints.size(), {}};
  Animation animation = retarget(motion, avatar, metres_of_unit(unit), path, loaded.report);
  animation.name = path;
  avatar.animations.push_back(std::move(animation));
  say_what_matched(loaded.report, path, verbosity);
  return loaded;
}

std::string describe(const LoadedMotion& motion) {
  const RetargetReport& report = motion.report;
  const std::string tall = fmt::format("the skeleton is {:.4g} units tall", report.height);
  return fmt::format("{} nodes follow {} of {} joints; {}{}; 1 unit is {:.4g} m here\n", report.matched.size(),
                     motion.joint_count - report.unmatched_joints.size(), motion.joint_count, tall,
                     report.likely_unit.empty() ? ", which is a person's height in no usual unit"
                                                : fmt::format(", likely {}", report.likely_unit),
                     report.metres_per_unit);
}

nlohmann::ordered_json to_json(const LoadedMotion& motion) {
  const RetargetReport& report = motion.report;
  nlohmann::ordered_json matched = nlohmann::ordered_json::array();
  for (const JointMatch& match : report.matched)
    matched.push_back(
        {{"joint", match.joint}, {"node", match.node}, {"by", match.how == JointMatch::How::kName ? "name" : "role"}});
  return {{"frames", motion.frame_count},
          {"frame_time_s", motion.frame_time_s},
          {"matched", matched},
          {"unmatched_joints", report.unmatched_joints},
          {"unmatched_nodes", report.unmatched_nodes},
          {"height", report.height},
          {"likely_unit", report.likely_unit},
          {"metres_per_unit", report.metres_per_unit}};
}

}  // namespace vestige::cli
