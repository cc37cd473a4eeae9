#include "traces/scene/facing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "traces/base/error.hpp"

namespace vestige {

std::optional<Facing> facing_named(std::string_view name) {
  const auto* found = std::ranges::find(kFacingNames, name);
  if (found == kFacingNames.end()) return std::nullopt;
  return static_cast<Facing>(found - kFacingNames.begin());
}

glm::dvec3 forward_of(Facing facing) {
  return turned_from_front({0, 0, 1}, facing);
}

Facing nearest_facing(const glm::dvec3& direction) {
  if (std::abs(direction.x) > std::abs(direction.z)) return direction.x > 0 ? Facing::kPlusX : Facing::kMinusX;
  return direction.z >= 0 ? Facing::kPlusZ : Facing::kMinusZ;
}

void take_recorded_facing(AvatarFacing& facing, std::string_view recorded) {
  if (recorded.empty()) return;
  if (const auto axis = facing_named(recorded))
    set_facing(facing, *axis, AvatarFacing::By::kTrace);
  else
    facing.doubt = fmt::format("the trace records the facing '{}', which is no axis", recorded);
}

std::string describe_lying(const AvatarFacing& facing) {
  return fmt::format("does not stand: at rest, its head lies {:.0f} degrees away from +Y as seen from its hips",
                     *facing.lies_deg);
}

void require_standing(const AvatarFacing& facing, std::string_view where) {
  if (!facing.lies_deg) return;
  throw Error(where, fmt::format("the avatar {}", describe_lying(facing)),
              fmt::format("turn the avatar's root node by {:.0f} degrees in the modelling program, so that its head is "
                          "above its hips, or export it with +Y up",
                          *facing.lies_deg));
}

std::string_view to_string(AvatarFacing::By by) {
  constexpr std::array<std::string_view, 7> kNames = {"sides", "feet", "vrm", "assumed", "map", "trace", "asked"};
  return kNames[static_cast<std::size_t>(by)];
}

std::string_view in_words(AvatarFacing::By by) {
  switch (by) {
    case AvatarFacing::By::kSides:
      return "by its left and right joints";
    case AvatarFacing::By::kFeet:
      return "by its feet";
    case AvatarFacing::By::kVrm:
      return "by its version of VRM";
    case AvatarFacing::By::kMap:
      return "by its map";
    case AvatarFacing::By::kTrace:
      return "by the trace";
    case AvatarFacing::By::kAsked:
      return "as asked";
    case AvatarFacing::By::kAssumed:
      break;
  }
  return "since nothing tells";
}

std::vector<std::string> settle_facing(AvatarFacing& facing, std::string_view asked, std::optional<Facing> of_map,
                                       std::string_view name) {
  std::vector<std::string> warnings;
  if (const auto axis = facing_named(asked)) {
    if (facing.by == AvatarFacing::By::kSides && facing.axis != *axis)
      warnings.push_back(fmt::format("{}: its left and right joints say that it faces {}; {} is taken, as asked", name,
                                     to_string(facing.axis), asked));
    set_facing(facing, *axis, AvatarFacing::By::kAsked);
  } else if (of_map && facing.by == AvatarFacing::By::kAssumed) {
    set_facing(facing, *of_map, AvatarFacing::By::kMap);
  }
  if (facing.lies_deg)
    warnings.push_back(fmt::format("{}: {}; its left and its front are not known", name, describe_lying(facing)));
  if (!facing.doubt.empty())
    warnings.push_back(
        fmt::format("{}: {}; {} is taken; --facing sets it", name, facing.doubt, to_string(facing.axis)));
  facing.doubt.clear();  // said once
  return warnings;
}

std::string other_facing(const AvatarFacing& facing, std::optional<Facing> of_map, const SceneNames& names) {
  if (!of_map || *of_map == facing.axis || facing.by == AvatarFacing::By::kAssumed) return {};
  return fmt::format("{}: was made for an avatar that faces {}, and {} faces {}, {}; make it anew", names.map,
                     to_string(*of_map), names.avatar, to_string(facing.axis), in_words(facing.by));
}

}  // namespace vestige
