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

/// What every result file says of where it comes from: schema_version, argv, commit, dirty, version, machine, time
/// (UTC).
nlohmann::ordered_json provenance(std::span<const std::string> argv);

/// The same as texts, for a trace's session.
std::map<std::string, std::string> provenance_texts(std::span<const std::string> argv);

nlohmann::ordered_json to_json(const Machine& machine);
nlohmann::ordered_json to_json(const GlInfo& gl);      ///< renderer, version, …; null for a detector without GL
nlohmann::ordered_json to_json(const Avatar& avatar);  ///< vertices, triangles, joints

/// The commit that this program was built from; a "+" behind it says that files had been changed since.
std::string commit();

/// Now, as "2026-11-21T01:40:00Z".
std::string utc_now();

}  // namespace vestige
