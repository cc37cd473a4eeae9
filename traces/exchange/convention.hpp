#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "traces/scene/trace.hpp"

namespace vestige {

/// The axes of a program. A trace has those of glTF: right-handed, +Y up, and a person who faces +Z has +X on the left.
struct AxisPreset {
  std::string_view name;
  std::string_view meaning;          ///< for help: handedness, up, forward
  std::string_view unit;             ///< in which the program gives lengths, unless told otherwise
  std::array<glm::dvec3, 3> images;  ///< what the program's +X, +Y and +Z are in a trace: unit vectors along axes
};

/// gltf, unity, unreal, blender, optitrack.
extern const std::array<AxisPreset, 5> kAxisPresets;

/// A unit of length or time: its name, and how many metres or seconds it has.
struct Unit {
  std::string_view name;
  double size = 1;
};

inline constexpr std::array<Unit, 4> kLengthUnits = {{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};
inline constexpr std::array<Unit, 2> kTimeUnits = {{{"s", 1}, {"ms", 0.001}}};

/// What turns the numbers of a file into those of a trace: metres, seconds, its axes.
struct Convention {
  double metres_per_unit = 1;
  double seconds_per_unit = 1;
  glm::dmat3 axes = glm::dmat3(1);      ///< columns: what the file's +X, +Y, +Z are in a trace
  glm::dvec3 offset_m = glm::dvec3(0);  ///< added to positions in the world, in the trace's axes

  /// Whether nothing changes, not even a bit.
  bool is_of_trace() const { return *this == Convention(); }
  friend bool operator==(const Convention&, const Convention&) = default;

  /// Returns a position in the world. The offset is added last.
  glm::dvec3 position_m(const glm::dvec3& given) const { return metres_per_unit * (axes * given) + offset_m; }
  /// Undoes `position_m`, up to rounding.
  glm::dvec3 given_position(const glm::dvec3& position_m) const;

  /// Changes a node's transform, which is relative to its parent, from the file's convention to the trace's. Holds
  /// where each node's own axes are given in the program's axes, too, as Unity's importers of glTF do it.
  NodeLocal node(const NodeLocal& given) const;
  /// Undoes `node`, up to rounding.
  NodeLocal given_node(const NodeLocal& node) const;
};

/// Returns the matrix of a preset. Precondition: `name` is one.
glm::dmat3 axes_named(std::string_view name);

}  // namespace vestige
