#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// One joint's weight on one vertex, as in the file: finite, not negative.
struct Influence {
  std::uint16_t palette = 0;
  double weight = 0;
};

/// Converts a file's influences of one vertex to the form that `Influences` promises. Leaves the same elements in
/// `influences`. Of more than `kMaxInfluences`, keeps the largest (of equal ones, the lowest palette indices). A vertex
/// without any weight follows `first`. Warns at `path` of both cases, and of weights whose sum is not 1.
Influences combine_influences(std::vector<Influence>& influences, std::uint16_t first, std::string_view path,
                              Report& report);

}  // namespace vestige::gltf
