#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/growth.hpp"

namespace vestige {

/// `by_colliders{series}`, `by_triangles[{triangles, vertices, frames, series}]`, `crossovers{colliders, triangles}`
/// and `ablation[…]`, the fields of `series` as in a sweep's JSON.
nlohmann::ordered_json to_json(const Growth& growth, std::uint64_t seed);

/// The tables for people: microseconds a frame against colliders and against triangles, where lines cross, and what
/// skipping saves.
std::string growth_table(const Growth& growth, std::uint32_t colliders);

}  // namespace vestige
