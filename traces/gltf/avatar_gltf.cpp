#include "traces/gltf/avatar_gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "traces/body/find_facing.hpp"
#include "traces/body/humanoid.hpp"
#include "traces/gltf/gltf_animation.hpp"
#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_load.hpp"
#include "traces/gltf/gltf_mesh.hpp"
#include "traces/gltf/gltf_nodes.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

using gltf::Report;

/// Returns the root node. In the lowest skin that is drawn, it is the lowest joint without a joint above it. Without
/// any skin, it is the first node that is drawn.
int find_root(const gltf::Document& document, const std::vector<bool>& drawn, const Avatar& avatar) {
  int skin = -1;
  int first_drawn = -1;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const tinygltf::Node& node = document.model.nodes[i];
    if (!drawn[i] || node.mesh < 0) continue;
    if (first_drawn < 0) first_drawn = static_cast<int>(i);
    if (node.skin >= 0 && (skin < 0 || node.skin < skin)) skin = node.skin;
  }
  if (skin < 0) return first_drawn;
  const std::vector<int>& joints = document.model.skins[static_cast<std::size_t>(skin)].joints;
  const std::set<int> is_joint(joints.begin(), joints.end());
  std::vector<bool> is_below(drawn.size());
  int root = -1;
  for (const int node : avatar.node_order) {
    const int parent = avatar.nodes[static_cast<std::size_t>(node)].parent;
    const bool has_joint_above =
        parent >= 0 && (is_below[static_cast<std::size_t>(parent)] || is_joint.contains(parent));
    is_below[static_cast<std::size_t>(node)] = has_joint_above;
    if (!has_joint_above && is_joint.contains(node) && (root < 0 || node < root)) root = node;
  }
  return root;
}

/// A scene that shows a skinned mesh should hold its joints, too (glTF 2.0 §3.7.3.1). The transforms of joints outside
/// the scene still count.
void warn_of_joints_outside(const gltf::Document& document, const std::vector<bool>& drawn, Report& report) {
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const tinygltf::Node& node = document.model.nodes[i];
    if (!drawn[i] || node.mesh < 0 || node.skin < 0) continue;
    const std::vector<int>& joints = document.model.skins[static_cast<std::size_t>(node.skin)].joints;
    if (!std::all_of(joints.begin(), joints.end(), [&](int joint) { return drawn[static_cast<std::size_t>(joint)]; }))
      report.warn(fmt::format("nodes[{}].skin", i), "has joints outside the scene");
  }
}

bool fits_into_float(double number) {
  return std::abs(number) <= double{std::numeric_limits<float>::max()};  // false for NaN
}

bool fits_into_float(const glm::dmat4& matrix) {
  for (int i = 0; i < 16; ++i)
    if (!fits_into_float(matrix[i / 4][i % 4])) return false;
  return true;
}

/// Finite numbers may still have a product that is too large for a float.
void refuse_rest_pose_beyond_float(const Avatar& avatar, const Report& report) {
  const auto fail = [&](int node, std::string_view cause) {
    report.fail(fmt::format("nodes[{}]", node), fmt::format("in the rest pose {} beyond the range of a float", cause),
                "scale the avatar down to metres");
  };
  std::vector<glm::dmat4> matrices;
  world_matrices(avatar, rest_pose(avatar), matrices);
  for (const int node : avatar.node_order)
    if (!fits_into_float(matrices[static_cast<std::size_t>(node)])) fail(node, "its global matrix is");
  palette_matrices(avatar, rest_pose(avatar), matrices);
  for (std::size_t i = 0; i < matrices.size(); ++i)
    if (!fits_into_float(matrices[i])) fail(avatar.palette[i].node, "its matrix times its inverse bind matrix is");
  for (std::size_t vertex = 0; vertex < avatar.position_bind.size(); ++vertex) {
    const glm::dvec3 position = skin_vertex(avatar, matrices, vertex);
    if (!fits_into_float(position.x) || !fits_into_float(position.y) || !fits_into_float(position.z))
      fail(avatar.palette[avatar.influences[vertex].palette[0]].node, fmt::format("it moves vertex {}", vertex));
  }
}

[[noreturn]] void fail_without_triangles(const Report& report) {
  std::string cause = "the default scene shows no triangles";
  for (const std::string& warning : report.warnings()) cause += "\n  also: " + warning;
  report.fail("", cause, "name a file that holds an avatar");
}

}  // namespace

Avatar parse_avatar_glb(std::span<const std::byte> glb, std::string_view name) {
  return gltf::load_avatar(glb, name).avatar;
}

gltf::LoadedAvatar gltf::load_avatar(std::span<const std::byte> glb, std::string_view name, DrawnMeshes* details) {
  Report report(name);
  LoadedAvatar loaded = {.document = load_document(glb, report), .avatar = {}, .skins = {}};
  const Document& document = loaded.document;
  Avatar& avatar = loaded.avatar;
  read_nodes(document, avatar, report);
  loaded.skins = read_skins(document, avatar, report);
  const std::vector<bool> drawn = nodes_drawn(document, avatar, report);
  MorphTargets morphs = read_meshes(document, loaded.skins, drawn, avatar, report, details);
  refuse_rest_pose_beyond_float(avatar, report);
  read_animations(document, morphs, avatar, report);
  if (avatar.triangles.empty()) fail_without_triangles(report);

  avatar.root_node = find_root(document, drawn, avatar);
  warn_of_joints_outside(document, drawn, report);
  std::set<int> joints;
  for (const Skin& skin : loaded.skins) joints.insert(skin.joints.begin(), skin.joints.end());
  avatar.joint_count = joints.size();
  avatar.humanoid = find_humanoid(avatar, document.json.extensions());
  avatar.facing = find_facing(avatar, avatar.humanoid);
  avatar.warnings = report.warnings();
  for (const std::string& problem : avatar.humanoid.problems)
    avatar.warnings.push_back(fmt::format("{}: {}", name, problem));
  if (const std::size_t more = avatar.humanoid.problem_count - avatar.humanoid.problems.size(); more > 0)
    avatar.warnings.push_back(fmt::format("{}: and {} more faults in its table of bones", name, more));
  return loaded;
}

}  // namespace vestige
