#include "traces/motion/animation_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

std::string list_animations(const Avatar& avatar) {
  if (avatar.animations.empty()) return "leave out --animation: the avatar has no animation";
  std::string list = "choose one that the avatar has:";
  for (std::size_t i = 0; i < avatar.animations.size(); ++i)
    fmt::format_to(std::back_inserter(list), "{} {} ({})", i == 0 ? "" : ",", i,
                   avatar.animations[i].name.empty() ? "unnamed" : avatar.animations[i].name);
  return list;
}

}  // namespace

const Animation* find_animation(const Avatar& avatar, const std::string& name_or_index) {
  if (name_or_index == "none" || (name_or_index.empty() && avatar.animations.empty())) return nullptr;
  if (name_or_index.empty()) return &avatar.animations.front();
  const auto named = std::ranges::find(avatar.animations, name_or_index, &Animation::name);
  if (named != avatar.animations.end()) return &*named;
  std::size_t index = 0;
  const char* end = name_or_index.data() + name_or_index.size();
  const auto parsed = std::from_chars(name_or_index.data(), end, index);
  if (parsed.ec == std::errc() && parsed.ptr == end && index < avatar.animations.size())
    return &avatar.animations[index];
  throw UsageError("--animation", fmt::format("there is no animation '{}'", name_or_index), list_animations(avatar));
}

std::string describe_morph(const Animation& animation) {
  return fmt::format("{} moves the skin by morph targets, by at most {:.3g} m (all at their most, in the rest pose)",
                     animation.name.empty() ? "an unnamed animation" : fmt::format("animation '{}'", animation.name),
                     animation.morph->reach_m);
}

}  // namespace vestige
