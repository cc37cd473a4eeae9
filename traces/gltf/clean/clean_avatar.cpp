#include "traces/gltf/clean/clean_avatar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>
#include <string>

#include "traces/gltf/clean/glb_builder.hpp"
#include "traces/gltf/clean/look.hpp"
#include "traces/gltf/glb_container.hpp"
#include "traces/gltf/gltf_influences.hpp"
#include "traces/gltf/gltf_load.hpp"

namespace vestige {

namespace {

using gltf::DrawnPart;
using gltf::GlbBuilder;
using gltf::Target;
using Json = GlbBuilder::Json;
using Weights = std::array<float, kMaxInfluences>;

constexpr std::size_t kSetSize = 4;  // weights of one attribute

/// Whether the sum of weights is as near to 1 as glTF's validator wants: within 2e-7 for each weight.
bool is_normalised(const Weights& weights) {
  double sum = 0;
  for (const float weight : weights) sum += double{weight};
  const auto count = std::count_if(weights.begin(), weights.end(), [](float weight) { return weight > 0; });
  return std::abs(sum - 1) < 1.9e-7 * static_cast<double>(count);
}

/// Returns the weights that the reader makes of `weights`.
Weights as_read(const Weights& weights, const Influences& influences) {
  std::vector<gltf::Influence> read;
  for (std::size_t i = 0; i < kMaxInfluences; ++i) read.push_back({influences.palette[i], double{weights[i]}});
  gltf::Report unused("");
  return gltf::combine_influences(read, 0, "", unused).weight;
}

/// Returns normalised weights that the reader reads as those of `influences`. Rounded weights rarely have the sum 1, so
/// the reader may change their last bits when it normalises them; slightly larger or smaller weights then keep them.
/// Where none do, a last bit changes.
Weights weights_to_write(const Influences& influences, const Weights& in_file) {
  const auto is_exact = [&](const Weights& weights) {
    return is_normalised(weights) && as_read(weights, influences) == influences.weight;
  };
  if (is_exact(in_file)) return in_file;
  constexpr int kMostSteps = 100;
  for (int step = 0; step < kMostSteps; ++step)
    for (const int sign : {1, -1}) {
      Weights scaled = influences.weight;
      const double scale = 1 + sign * std::ldexp(step, -26);
      for (float& weight : scaled) weight = static_cast<float>(double{weight} * scale);
      if (is_exact(scaled)) return scaled;
    }
  return influences.weight;
}

/// A matrix as rotation * scale * rotation: its singular value decomposition.
struct Turns {
  glm::quat outer;
  glm::vec3 scale;
  glm::quat inner;
};

/// Turns pairs of columns until all are at right angles (one-sided Jacobi).
Turns decompose(const glm::dmat3& matrix) {
  glm::dmat3 columns = matrix;
  glm::dmat3 turned(1.0);
  constexpr int kSweeps = 40;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      const double angle = 0.5 * std::atan2(2 * glm::dot(columns[p], columns[q]),
                                            glm::dot(columns[p], columns[p]) - glm::dot(columns[q], columns[q]));
      for (glm::dmat3* m : {&columns, &turned}) {
        const glm::dvec3 a = (*m)[p];
        const glm::dvec3 b = (*m)[q];
        (*m)[p] = std::cos(angle) * a + std::sin(angle) * b;
        (*m)[q] = std::cos(angle) * b - std::sin(angle) * a;
      }
    }
  // The columns are now sorted: the longest comes first. A column without length takes any direction.
  glm::dvec3 scale(glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2]));
  const double least = 1e-12 * scale.x;
  glm::dmat3 directions(1.0);
  if (scale.x > 0) {
    directions[0] = columns[0] / scale.x;
    const glm::dvec3 across = std::abs(directions[0].x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    directions[1] = scale.y > least ? columns[1] / scale.y : glm::normalize(glm::cross(directions[0], across));
    directions[2] = glm::cross(directions[0], directions[1]);
    if (glm::dot(directions[2], columns[2]) < 0) scale.z = -scale.z;
  }
  return {glm::quat(glm::normalize(glm::quat_cast(directions))), glm::vec3(scale),
          glm::quat(glm::normalize(glm::quat_cast(glm::transpose(turned))))};
}

/// Returns a rotation of length 1: as it is if it is near enough for glTF's validator.
glm::quat unit(const glm::quat& rotation) {
  const glm::dquat exact(rotation);
  const bool is_in_range = std::max({std::abs(exact.x), std::abs(exact.y), std::abs(exact.z), std::abs(exact.w)}) <= 1;
  return is_in_range && std::abs(glm::length(exact) - 1) < 1e-3 ? rotation : glm::quat(glm::normalize(exact));
}

Json numbers(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

Json numbers(const glm::quat& q) {
  return {q.x, q.y, q.z, q.w};
}

/// Writes an avatar anew, with the nodes, skins and parts of its file in their order.
class Writer {
 public:
  Writer(std::span<const std::byte> glb, std::string_view name)
      : report_(name),
        loaded_(gltf::load_avatar(glb, name, &meshes_)),
        avatar_(loaded_.avatar),
        look_(glb, loaded_.document, builder_) {}

  std::vector<std::byte> write() {
    builder_.json["asset"] = look_.asset();
    builder_.json["scene"] = 0;
    builder_.json["scenes"] = Json::array();
    for (std::size_t i = 0; i < avatar_.nodes.size(); ++i) add_node(i);
    place_fixed_nodes();
    link_nodes();
    for (const gltf::Skin& skin : loaded_.skins) add_skin(skin);
    for (const DrawnPart& part : meshes_.parts) add_part(part);
    for (const Animation& animation : avatar_.animations) add_animation(animation);
    look_.finish();
    builder_.json["buffers"] = Json::array({{{"byteLength", builder_.bin.size()}}});
    return gltf::join_glb(builder_.json.dump(), builder_.bin, report_);
  }

 private:
  Json& node(int index) { return builder_.json["nodes"][static_cast<std::size_t>(index)]; }

  static void set_transform(Json& node, const NodeLocal& local) {
    const NodeLocal none;
    if (local.translation != none.translation) node["translation"] = numbers(local.translation);
    if (unit(local.rotation) != none.rotation) node["rotation"] = numbers(unit(local.rotation));
    if (local.scale != none.scale) node["scale"] = numbers(local.scale);
  }

  void add_node(std::size_t index) {
    Json added = Json::object();
    const Node& source = avatar_.nodes[index];
    if (!source.name.empty()) added["name"] = source.name;
    if (!source.fixed_matrix) set_transform(added, source.rest);
    builder_.add("nodes", std::move(added));
    above_.push_back(source.parent);
  }

  /// glTF allows only matrices that are a product of translation, rotation and scale. Any other takes two nodes: the
  /// new one turns and scales, and the node itself turns once more below it.
  void place_fixed_nodes() {
    for (std::size_t i = 0; i < avatar_.nodes.size(); ++i) {
      const std::optional<glm::dmat4>& matrix = avatar_.nodes[i].fixed_matrix;
      if (!matrix) continue;
      const Turns turns = decompose(glm::dmat3(*matrix));
      Json above = Json::object();
      set_transform(above, {glm::vec3((*matrix)[3]), turns.outer, turns.scale});
      set_transform(node(static_cast<int>(i)), {glm::vec3(0), turns.inner, glm::vec3(1)});
      above_.push_back(above_[i]);
      above_[i] = builder_.add("nodes", std::move(above));
    }
  }

  int root_of(int index) const {
    while (above_[static_cast<std::size_t>(index)] >= 0) index = above_[static_cast<std::size_t>(index)];
    return index;
  }

  /// Writes the children of each node, and the roots as the scene. The joints of a skin must have a common root, so
  /// roots that a skin joins get a node above them.
  void link_nodes() {
    std::set<int> joined;
    for (const gltf::Skin& skin : loaded_.skins) {
      std::set<int> roots;
      for (const int joint : skin.joints) roots.insert(root_of(joint));
      if (roots.size() > 1) joined.insert(roots.begin(), roots.end());
    }
    if (!joined.empty()) {
      const int above = builder_.add("nodes", {{"name", "common root"}});
      above_.push_back(-1);
      for (const int root : joined) above_[static_cast<std::size_t>(root)] = above;
    }
    Json roots = Json::array();
    for (std::size_t i = 0; i < above_.size(); ++i) {
      if (above_[i] < 0)
        roots.push_back(i);
      else
        node(above_[i])["children"].push_back(i);
    }
    builder_.json["scenes"].push_back({{"nodes", roots}});
  }

  void add_skin(const gltf::Skin& skin) {
    std::vector<float> matrices;
    for (const glm::dmat4& matrix : skin.inverse_bind)
      for (int i = 0; i < 16; ++i) matrices.push_back(static_cast<float>(matrix[i / 4][i % 4]));
    builder_.add("skins", {{"joints", skin.joints},
                           {"inverseBindMatrices", builder_.add_accessor(matrices, "MAT4", 16, Target::kNone)}});
  }

  void add_part(const DrawnPart& part) {
    Json primitive = {{"attributes", attributes(part)}, {"indices", add_indices(part)}};
    look_.set_material(primitive, part.mesh, part.primitive);
    const auto [mesh, is_new] = mesh_of_.try_emplace(part.node, builder_.json["meshes"].size());
    if (is_new) {
      builder_.add("meshes", {{"primitives", Json::array()}});
      node(part.node)["mesh"] = mesh->second;
      if (part.skin >= 0) node(part.node)["skin"] = part.skin;
    }
    builder_.json["meshes"][mesh->second]["primitives"].push_back(std::move(primitive));
  }

  const Json& attributes(const DrawnPart& part) {
    const auto [known, is_new] = attributes_of_.try_emplace(part.first_vertex);
    if (!is_new) return known->second;
    const auto vertices = [&](const auto& all) { return std::span(all).subspan(part.first_vertex, part.vertex_count); };
    Json& result = known->second;
    std::vector<float> positions;
    for (const glm::vec3& p : vertices(avatar_.position_bind)) positions.insert(positions.end(), {p.x, p.y, p.z});
    result["POSITION"] = builder_.add_bounded_accessor(positions, "VEC3", 3, Target::kVertices);
    look_.add_normals(result, part.mesh, part.primitive, part.vertex_count);
    std::vector<float> places;
    for (const glm::vec2& uv : vertices(avatar_.texture_coordinate)) places.insert(places.end(), {uv.x, uv.y});
    result["TEXCOORD_0"] = builder_.add_accessor(places, "VEC2", 2, Target::kVertices);
    if (part.skin >= 0) add_influences(part, result);
    return result;
  }

  void add_influences(const DrawnPart& part, Json& attributes) {
    const std::vector<int>& joints = loaded_.skins[static_cast<std::size_t>(part.skin)].joints;
    std::map<int, std::uint16_t> joint_of;
    for (std::size_t i = 0; i < joints.size(); ++i) joint_of[joints[i]] = static_cast<std::uint16_t>(i);
    std::array<std::vector<std::uint16_t>, kMaxInfluences / kSetSize> joint_sets;
    std::array<std::vector<float>, kMaxInfluences / kSetSize> weight_sets;
    std::size_t set_count = 1;
    for (std::size_t vertex = part.first_vertex; vertex < part.first_vertex + part.vertex_count; ++vertex) {
      const Influences& influences = avatar_.influences[vertex];
      const Weights weights = weights_to_write(influences, meshes_.weights[vertex]);
      for (std::size_t i = 0; i < kMaxInfluences; ++i) {
        const int joint = avatar_.palette[influences.palette[i]].node;
        joint_sets[i / kSetSize].push_back(weights[i] > 0 ? joint_of.at(joint) : std::uint16_t{0});
        weight_sets[i / kSetSize].push_back(weights[i]);
        if (weights[i] > 0) set_count = std::max(set_count, i / kSetSize + 1);
      }
    }
    for (std::size_t set = 0; set < set_count; ++set) {
      const std::string number = std::to_string(set);
      attributes["JOINTS_" + number] = builder_.add_accessor(joint_sets[set], "VEC4", 4, Target::kVertices);
      attributes["WEIGHTS_" + number] = builder_.add_accessor(weight_sets[set], "VEC4", 4, Target::kVertices);
    }
  }

  int add_indices(const DrawnPart& part) {
    std::vector<std::uint32_t> indices;
    for (glm::uvec3 triangle : std::span(avatar_.triangles).subspan(part.first_triangle, part.triangle_count)) {
      if (part.is_mirrored) std::swap(triangle.y, triangle.z);
      for (int corner = 0; corner < 3; ++corner)
        indices.push_back(triangle[corner] - static_cast<std::uint32_t>(part.first_vertex));
    }
    if (part.vertex_count > 0xFFFF) return builder_.add_accessor(indices, "SCALAR", 1, Target::kIndices);
    return builder_.add_accessor(std::vector<std::uint16_t>(indices.begin(), indices.end()), "SCALAR", 1,
                                 Target::kIndices);
  }

  void add_animation(const Animation& animation) {
    if (animation.channels.empty()) return;  // glTF forbids it
    Json json = {{"channels", Json::array()}, {"samplers", Json::array()}};
    if (!animation.name.empty()) json["name"] = animation.name;
    for (const AnimationChannel& channel : animation.channels) {
      const auto [input, is_new] = input_of_.try_emplace(channel.times_s);
      if (is_new) input->second = builder_.add_bounded_accessor(channel.times_s, "SCALAR", 1, Target::kNone);
      json["channels"].push_back({{"sampler", json["samplers"].size()},
                                  {"target", {{"node", channel.node}, {"path", path_of(channel.property)}}}});
      json["samplers"].push_back({{"input", input->second},
                                  {"interpolation", name_of(channel.interpolation)},
                                  {"output", add_values(channel)}});
    }
    builder_.add("animations", std::move(json));
  }

  int add_values(const AnimationChannel& channel) {
    if (channel.property != AnimatedProperty::kRotation)
      return builder_.add_accessor(channel.values, "VEC3", 3, Target::kNone);
    std::vector<float> values = channel.values;
    const bool is_spline = channel.interpolation == Interpolation::kCubicSpline;
    for (std::size_t key = 0; key < channel.times_s.size(); ++key) {
      float* q = &values[4 * (is_spline ? 3 * key + 1 : key)];
      const glm::quat rotation = unit(glm::quat(q[3], q[0], q[1], q[2]));
      std::copy_n(std::array{rotation.x, rotation.y, rotation.z, rotation.w}.begin(), 4, q);
    }
    return builder_.add_accessor(values, "VEC4", 4, Target::kNone);
  }

  static const char* path_of(AnimatedProperty property) {
    if (property == AnimatedProperty::kTranslation) return "translation";
    return property == AnimatedProperty::kRotation ? "rotation" : "scale";
  }

  static const char* name_of(Interpolation interpolation) {
    if (interpolation == Interpolation::kStep) return "STEP";
    return interpolation == Interpolation::kLinear ? "LINEAR" : "CUBICSPLINE";
  }

  gltf::Report report_;
  gltf::DrawnMeshes meshes_;
  gltf::LoadedAvatar loaded_;
  const Avatar& avatar_;
  GlbBuilder builder_;
  gltf::Look look_;
  std::vector<int> above_;  ///< the parent of each node that is written, -1 for a root
  std::map<int, std::size_t> mesh_of_;
  std::map<std::size_t, Json> attributes_of_;  ///< by first vertex
  std::map<std::vector<float>, int> input_of_;
};

}  // namespace

std::vector<std::byte> clean_avatar_glb(std::span<const std::byte> glb, std::string_view name) {
  return Writer(glb, name).write();
}

}  // namespace vestige
