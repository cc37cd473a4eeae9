#include "traces/exchange/convention.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace vestige {

namespace {

constexpr glm::dvec3 kX = {1, 0, 0};
constexpr glm::dvec3 kMinusX = {-1, 0, 0};
constexpr glm::dvec3 kY = {0, 1, 0};
constexpr glm::dvec3 kZ = {0, 0, 1};
constexpr glm::dvec3 kMinusZ = {0, 0, -1};

/// `axes` is a permutation with signs, so products with it are exact. A reflection turns the sense of a rotation.
NodeLocal turned(const NodeLocal& node, const glm::dmat3& axes, double scale) {
  const double sense = glm::determinant(axes) < 0 ? -1 : 1;
  const glm::dvec3 axis = sense * (axes * glm::dvec3(node.rotation.x, node.rotation.y, node.rotation.z));
  NodeLocal result = node;
  result.translation = glm::vec3(scale * (axes * glm::dvec3(node.translation)));
  result.rotation.x = static_cast<float>(axis.x);
  result.rotation.y = static_cast<float>(axis.y);
  result.rotation.z = static_cast<float>(axis.z);
  const glm::dmat3 places = {glm::abs(axes[0]), glm::abs(axes[1]), glm::abs(axes[2])};
  result.scale = glm::vec3(places * glm::dvec3(node.scale));
  return result;
}

}  // namespace

const std::array<AxisPreset, 5> kAxisPresets = {{
    {"gltf", "right-handed, +Y up, forward +Z: as in a trace", "m", {kX, kY, kZ}},
    {"unity", "left-handed, +Y up, forward +Z", "m", {kMinusX, kY, kZ}},
    {"unreal", "left-handed, +Z up, forward +X, in centimetres", "cm", {kZ, kMinusX, kY}},
    {"blender", "right-handed, +Z up, forward -Y", "m", {kX, kMinusZ, kY}},
    {"optitrack", "right-handed, +Y up: as in a trace", "m", {kX, kY, kZ}},
}};

glm::dvec3 Convention::given_position(const glm::dvec3& position_m) const {
  return glm::transpose(axes) * ((position_m - offset_m) / metres_per_unit);
}

NodeLocal Convention::node(const NodeLocal& given) const {
  return turned(given, axes, metres_per_unit);
}

NodeLocal Convention::given_node(const NodeLocal& node) const {
  return turned(node, glm::transpose(axes), 1 / metres_per_unit);
}

glm::dmat3 axes_named(std::string_view name) {
  const AxisPreset& preset = *std::ranges::find(kAxisPresets, name, &AxisPreset::name);
  return {preset.images[0], preset.images[1], preset.images[2]};
}

}  // namespace vestige
