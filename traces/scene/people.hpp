#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Most colliders of a trace, and most teleports of a frame. Readers refuse more.
inline constexpr std::size_t kMostColliders = 1'000'000;

/// The largest number of a person that `ColliderSample::owner` can hold.
inline constexpr std::size_t kMostOwners = std::numeric_limits<std::uint16_t>::max();

/// Returns "person 2", or "nobody".
inline std::string in_words(std::uint16_t owner) {
  return owner == kNobody ? "nobody" : fmt::format("person {}", owner);
}

/// Returns "1 person" or "2 people".
inline std::string count_of_people(std::size_t people) {
  return people == 1 ? "1 person" : fmt::format("{} people", people);
}

/// Returns what is wrong with the owners of a frame's colliders in a trace of this many people; nothing if each owner
/// is there.
inline std::optional<std::string> owner_fault(std::span<const ColliderSample> colliders, std::size_t people) {
  for (const ColliderSample& collider : colliders)
    if (collider.owner > people)
      return fmt::format("collider {} belongs to person {}, and there {} only {}", collider.id, collider.owner,
                         people == 1 ? "is" : "are", people);
  return {};
}

}  // namespace vestige
