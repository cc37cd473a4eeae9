#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/growth.hpp"

namespace vestige {

/// Returns `frame_limit_s`, `by_colliders{series}`, `by_triangles[{triangles, vertices, frames, series}]`,
/// `left_out{colliders, triangles}`, `crossovers{colliders, triangles}` and `ablation[…]`. The fields of `series` are
/// as in a sweep's JSON; points also have `memory_bytes`.
nlohmann::ordered_json to_json(const Growth& growth, std::uint64_t seed);

/// Returns tables for people: microseconds of a frame against colliders and against triangles, who was left out, the
/// crossings, the memory, and what skipping saves.
std::string growth_table(const Growth& growth, std::uint32_t colliders);

}  // namespace vestige
