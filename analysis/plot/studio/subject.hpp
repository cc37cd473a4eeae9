#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "detector/actuator_map.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// The actuator of the skin where the triangle's second and third vertex weigh u and v, by the very look-up that
/// detectors use.
std::uint16_t actuator_at(const Avatar& avatar, const ActuatorMap& map, std::uint32_t triangle, double u, double v);

/// Who is drawn.
struct Subject {
  std::string title;
  Avatar avatar;
  ActuatorMap map;  ///< without actuators where there is none

  std::uint16_t actuator_at(std::uint32_t triangle, double u, double v) const {
    return plot::actuator_at(avatar, map, triangle, u, v);
  }
};

/// "builtin", "none", a layout's name (as it lies on `avatar`), or a PNG file, whose sidecar is the .json of the same
/// name, if there is one. Throws `Error`.
ActuatorMap read_map(const std::string& map, const Avatar& avatar);

/// `avatar`: "builtin" or a glTF file. `map`: as for `read_map`; empty: "builtin" for the built-in avatar, else "none".
/// Throws `Error`.
Subject read_subject(const std::string& avatar, const std::string& map);

/// The avatar of a trace, with the trace's map or, unless it is empty, with `map`. Throws `Error`.
Subject read_subject(const TraceReader& trace, const std::filesystem::path& path, const std::string& map);

}  // namespace vestige::plot
