#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "detector/actuator_map.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// Returns the actuator of the skin at which the triangle's second and third vertex weigh u and v, with the look-up
/// that detectors use.
std::uint16_t actuator_at(const Avatar& avatar, const ActuatorMap& map, std::uint32_t triangle, double u, double v);

/// The avatar that is drawn, with its map.
struct Subject {
  std::string title;
  Avatar avatar;
  ActuatorMap map;                    ///< has no actuators if there is no map
  std::vector<std::string> warnings;  ///< about the facing, one sentence each

  std::uint16_t actuator_at(std::uint32_t triangle, double u, double v) const {
    return plot::actuator_at(avatar, map, triangle, u, v);
  }
};

/// Reads a map. `map` is "builtin", "none", a layout's name (laid onto `avatar`), or a PNG file. A PNG file's sidecar
/// is the .json file of the same name, if it exists. Throws `Error`.
ActuatorMap read_map(const std::string& map, const Avatar& avatar);

/// Reads an avatar with its map. `avatar` is "builtin" or a glTF file. `map` is as in `read_map`; if empty, it is
/// "builtin" for the built-in avatar and "none" for others. `facing` is an axis that is asked for, or "auto". Throws
/// `Error`.
Subject read_subject(const std::string& avatar, const std::string& map, std::string_view facing);

/// Returns a person of a trace, counted from 0, with the person's map, or with `map` if `map` is not empty. Throws
/// `Error`.
Subject read_subject(const TraceReader& trace, const std::filesystem::path& path, const std::string& map,
                     std::size_t person = 0);

}  // namespace vestige::plot
