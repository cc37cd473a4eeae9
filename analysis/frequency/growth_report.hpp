#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/growth.hpp"

namespace vestige {

/// Returns `by_colliders{series}`, `by_triangles[{triangles, vertices, frames, series}]`, `crossovers{colliders,
/// triangles}` and `ablation[…]`. The fields of `series` are as in a sweep's JSON.
nlohmann::ordered_json to_json(const Growth& growth, std::uint64_t seed);

/// Returns tables for people: microseconds of a frame against colliders and against triangles, the crossings, and what
/// skipping saves.
std::string growth_table(const Growth& growth, std::uint32_t colliders);

}  // namespace vestige
