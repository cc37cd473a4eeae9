#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// One joint's weight on one vertex, as the file gives it: finite, not negative.
struct Influence {
  std::uint16_t palette = 0;
  double weight = 0;
};

/// Puts what a file says of one vertex into the form that `Influences` promises; `influences` is left with as many
/// elements as that has. More than `kMaxInfluences`: the largest are kept (of equal ones, the lowest palette indices).
/// No weight at all: the vertex follows `first`. Both, and weights whose sum is not 1, are warned of at `path`.
Influences combine_influences(std::vector<Influence>& influences, std::uint16_t first, std::string_view path,
                              Report& report);

}  // namespace vestige::gltf
