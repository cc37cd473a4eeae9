#include "traces/gltf/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vestige::gltf {

namespace {

using Index = std::size_t;

std::string node_path(Index node, std::string_view property = {}) {
  return fmt::format("nodes[{}]{}", node, property);
}

void link_children(const Document& document, Avatar& avatar, const Report& report) {
  for (Index parent = 0; parent < avatar.nodes.size(); ++parent)
    for (const int child : document.model.nodes[parent].children) {
      Node& node = avatar.nodes[static_cast<Index>(child)];
      if (node.parent >= 0)
        report.fail(node_path(static_cast<Index>(child)),
                    fmt::format("is a child of nodes[{}] and again of nodes[{}]", node.parent, parent));
      node.parent = static_cast<int>(parent);
    }
}

/// Orders nodes: roots, then their children, and so on. Nodes in a cycle are not reached.
void order_nodes(const Document& document, Avatar& avatar, const Report& report) {
  std::vector<bool> reached(avatar.nodes.size());
  for (Index i = 0; i < avatar.nodes.size(); ++i)
    if (avatar.nodes[i].parent < 0) avatar.node_order.push_back(static_cast<int>(i));
  for (Index next = 0; next < avatar.node_order.size(); ++next) {
    const auto node = static_cast<Index>(avatar.node_order[next]);
    reached[node] = true;
    const std::vector<int>& children = document.model.nodes[node].children;
    avatar.node_order.insert(avatar.node_order.end(), children.begin(), children.end());
  }
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost == reached.end()) return;
  // The lost node may only hang below the cycle; this many steps up lead into the cycle.
  auto node = static_cast<Index>(lost - reached.begin());
  for (Index step = 0; step < avatar.nodes.size(); ++step) node = static_cast<Index>(avatar.nodes[node].parent);
  report.fail(node_path(node, ".children"), "leads back to the node itself");
}

/// Returns translation, rotation and scale whose product, after rounding to float, equals `matrix` to 1e-6. Returns
/// nothing if shear or a vanishing axis prevents that.
std::optional<NodeLocal> decompose(const glm::dmat4& matrix) {
  const glm::dmat3 linear(matrix);
  glm::dvec3 scale(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) return std::nullopt;
  if (glm::determinant(linear) < 0) scale.x = -scale.x;
  const glm::dmat3 rotation(linear[0] / scale.x, linear[1] / scale.y, linear[2] / scale.z);

  NodeLocal local;
  local.translation = glm::vec3(matrix[3]);
  local.rotation = glm::quat(glm::normalize(glm::quat_cast(rotation)));
  local.scale = glm::vec3(scale);
  const glm::dmat3 again = glm::mat3_cast(glm::normalize(glm::dquat(local.rotation)));
  const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double error = std::abs(again[column][row] * double{local.scale[column]} - linear[column][row]);
      if (!(error <= 1e-6 * largest)) return std::nullopt;
    }
  return local;
}

void read_matrix(const std::vector<double>& numbers, Index index, Node& node, Report& report) {
  const std::optional<glm::dmat4> matrix = affine_matrix(numbers.data());
  if (!matrix) report.fail(node_path(index, ".matrix"), "is not an affine transform: its last row is not 0 0 0 1");
  if (const std::optional<NodeLocal> local = decompose(*matrix)) {
    node.rest = *local;
    return;
  }
  report.warn(node_path(index, ".matrix"), "is not a product of translation, rotation and scale; it is used as it is");
  node.fixed_matrix = matrix;
}

void read_translation_rotation_scale(const tinygltf::Node& source, Index index, Node& node, Report& report) {
  const auto& [t, r, s] = std::tie(source.translation, source.rotation, source.scale);
  if (!t.empty()) node.rest.translation = glm::vec3(glm::dvec3(t[0], t[1], t[2]));
  if (!s.empty()) node.rest.scale = glm::vec3(glm::dvec3(s[0], s[1], s[2]));
  if (r.empty()) return;
  node.rest.rotation = glm::quat(glm::dquat(r[3], r[0], r[1], r[2]));
  const double length = glm::length(glm::dquat(node.rest.rotation));
  if (!(length > 0)) report.fail(node_path(index, ".rotation"), "is zero, which is not a rotation");
  if (std::abs(length - 1) > 1e-3)
    report.warn(node_path(index, ".rotation"), "does not have length 1 and is normalised");
}

}  // namespace

std::optional<glm::dmat4> affine_matrix(const double* numbers) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[i];
  const auto is_near = [](double value, double wanted) { return std::abs(value - wanted) <= 1e-6; };
  if (!is_near(matrix[0].w, 0) || !is_near(matrix[1].w, 0) || !is_near(matrix[2].w, 0) || !is_near(matrix[3].w, 1))
    return std::nullopt;
  matrix[0].w = matrix[1].w = matrix[2].w = 0;
  matrix[3].w = 1;
  return matrix;
}

void read_nodes(const Document& document, Avatar& avatar, Report& report) {
  avatar.nodes.resize(document.model.nodes.size());
  for (Index i = 0; i < avatar.nodes.size(); ++i) {
    const tinygltf::Node& source = document.model.nodes[i];
    avatar.nodes[i].name = source.name;
    if (!source.matrix.empty())
      read_matrix(source.matrix, i, avatar.nodes[i], report);
    else
      read_translation_rotation_scale(source, i, avatar.nodes[i], report);
  }
  link_children(document, avatar, report);
  order_nodes(document, avatar, report);
}

std::vector<bool> nodes_drawn(const Document& document, const Avatar& avatar, Report& report) {
  const std::vector<tinygltf::Scene>& scenes = document.model.scenes;
  if (scenes.empty()) return std::vector<bool>(avatar.nodes.size(), true);
  std::vector<bool> drawn(avatar.nodes.size());
  const auto scene = static_cast<Index>(std::max(document.model.defaultScene, 0));
  for (const int root : scenes[scene].nodes) {
    if (drawn[static_cast<Index>(root)]) report.warn(fmt::format("scenes[{}].nodes", scene), "names a node twice");
    drawn[static_cast<Index>(root)] = true;
    if (avatar.nodes[static_cast<Index>(root)].parent >= 0)
      report.warn(fmt::format("scenes[{}].nodes", scene), "names a node that is a child of another");
  }
  for (const int node : avatar.node_order) {
    const int parent = avatar.nodes[static_cast<Index>(node)].parent;
    if (parent >= 0 && drawn[static_cast<Index>(parent)]) drawn[static_cast<Index>(node)] = true;
  }
  return drawn;
}

}  // namespace vestige::gltf
