#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "traces/gltf/gltf_accessor.hpp"
#include "traces/gltf/gltf_mesh.hpp"
#include "traces/gltf/gltf_nodes.hpp"

namespace vestige::gltf {

namespace {

std::string skin_path(std::size_t skin, std::string_view property) {
  return fmt::format("skins[{}].{}", skin, property);
}

void refuse_repeated_joints(const std::vector<int>& joints, std::size_t skin, const Report& report) {
  std::vector<int> sorted = joints;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    report.fail(skin_path(skin, "joints"), fmt::format("names nodes[{}] more than once", *twice));
}

std::vector<glm::dmat4> read_inverse_bind(const Document& document, const tinygltf::Skin& source, std::size_t skin,
                                          Report& report) {
  const std::size_t count = source.joints.size();
  std::vector<glm::dmat4> matrices(count, glm::dmat4(1.0));
  if (source.inverseBindMatrices < 0) return matrices;
  const std::string path = skin_path(skin, "inverseBindMatrices");
  const AccessorReader reader(document, source.inverseBindMatrices, {TINYGLTF_TYPE_MAT4, kFloat}, path, report);
  for (std::size_t joint = 0; joint < count; ++joint) {
    std::array<double, 16> numbers = {};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = double{reader.finite(joint, i)};
    const std::optional<glm::dmat4> matrix = affine_matrix(numbers.data());
    if (!matrix) report.fail(path, fmt::format("matrix {} is not affine: its last row is not 0 0 0 1", joint));
    matrices[joint] = *matrix;
  }
  return matrices;
}

/// Numbers the nodes so that the descendants of a node are consecutive. Two comparisons then tell whether one node is
/// below another.
struct Tree {
  std::vector<std::size_t> first;  ///< a node's own number
  std::vector<std::size_t> size;   ///< size of the node's subtree
  std::vector<int> root;           ///< its topmost ancestor

  explicit Tree(const Avatar& avatar) : first(avatar.nodes.size()), size(avatar.nodes.size(), 1), root(first.size()) {
    const auto index = [](int node) { return static_cast<std::size_t>(node); };
    for (auto node = avatar.node_order.rbegin(); node != avatar.node_order.rend(); ++node)
      if (const int parent = avatar.nodes[index(*node)].parent; parent >= 0) size[index(parent)] += size[index(*node)];
    std::size_t next_root = 0;
    std::vector<std::size_t> next_child(first.size());
    for (const int node : avatar.node_order) {
      const int parent = avatar.nodes[index(node)].parent;
      std::size_t& next = parent < 0 ? next_root : next_child[index(parent)];
      first[index(node)] = next;
      next += size[index(node)];
      next_child[index(node)] = first[index(node)] + 1;
      root[index(node)] = parent < 0 ? node : root[index(parent)];
    }
  }

  bool is_below(int node, int ancestor) const {
    const auto above = static_cast<std::size_t>(ancestor);
    const std::size_t number = first[static_cast<std::size_t>(node)];
    return number >= first[above] && number < first[above] + size[above];
  }
};

/// glTF 2.0 §3.7.3.1 requires all joints in one tree, and `skeleton` above them all.
void check_hierarchy(const tinygltf::Skin& source, const Tree& tree, std::size_t skin, Report& report) {
  const auto root_of = [&](int joint) { return tree.root[static_cast<std::size_t>(joint)]; };
  if (!std::all_of(source.joints.begin(), source.joints.end(),
                   [&](int joint) { return root_of(joint) == root_of(source.joints.front()); }))
    report.warn(skin_path(skin, "joints"), "have no common root node");
  if (source.skeleton >= 0 && !std::all_of(source.joints.begin(), source.joints.end(),
                                           [&](int joint) { return tree.is_below(joint, source.skeleton); }))
    report.warn(skin_path(skin, "skeleton"), "is not above all joints");
}

/// Runs before any matrix is read, because an accessor with too few matrices may have wrong ones as well.
void check_counts(const Document& document, const Report& report) {
  for (std::size_t i = 0; i < document.model.skins.size(); ++i) {
    const tinygltf::Skin& skin = document.model.skins[i];
    if (skin.inverseBindMatrices < 0) continue;
    const std::size_t count = document.accessors[static_cast<std::size_t>(skin.inverseBindMatrices)].count;
    if (count < skin.joints.size())
      report.fail(skin_path(i, "inverseBindMatrices"),
                  fmt::format("has {} matrices for {} joints", count, skin.joints.size()));
  }
}

}  // namespace

std::vector<Skin> read_skins(const Document& document, const Avatar& avatar, Report& report) {
  check_counts(document, report);
  const Tree tree(avatar);
  std::vector<Skin> skins;
  for (std::size_t i = 0; i < document.model.skins.size(); ++i) {
    const tinygltf::Skin& source = document.model.skins[i];
    refuse_repeated_joints(source.joints, i, report);
    check_hierarchy(source, tree, i, report);
    skins.push_back({source.joints, read_inverse_bind(document, source, i, report)});
  }
  return skins;
}

}  // namespace vestige::gltf
