#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The machine that a measurement ran on.
struct Machine {
  std::string processor;
  unsigned cores = 0;
  std::uint64_t memory_bytes = 0;
  std::string system;  ///< operating system and kernel
};
Machine this_machine();

/// Returns what every result file says about its origin: schema_version, argv, commit, dirty, version, machine, time
/// (UTC).
nlohmann::ordered_json provenance(std::span<const std::string> argv);

/// Returns the same, followed by what `result` says, whose values win.
nlohmann::ordered_json with_provenance(std::span<const std::string> argv, const nlohmann::ordered_json& result);

/// Returns the values of `provenance` as texts, for a trace's session.
std::map<std::string, std::string> provenance_texts(std::span<const std::string> argv);

nlohmann::ordered_json to_json(const Machine& machine);
nlohmann::ordered_json to_json(const GlInfo& gl);      ///< renderer, version, …; null for a detector without GL
nlohmann::ordered_json to_json(const Avatar& avatar);  ///< vertices, triangles, joints, facing, facing_by

/// Returns the commit that this program was built from. A "+" at the end means that files had been changed since.
std::string commit();

/// Returns the current time, as "2026-11-21T01:40:00Z".
std::string utc_now();

}  // namespace vestige
