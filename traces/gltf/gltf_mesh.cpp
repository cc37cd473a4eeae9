#include "traces/gltf/gltf_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "traces/gltf/gltf_accessor.hpp"
#include "traces/gltf/gltf_influences.hpp"

namespace vestige::gltf {

namespace {

// A larger avatar would be useless.
constexpr std::size_t kMostVertices = std::size_t{1} << 23;
constexpr std::size_t kMostTriangles = std::size_t{1} << 24;
// A small file can show one mesh thousands of times. Its size plus this many vertices limits the memory it can request.
constexpr std::size_t kMostRepeated = std::size_t{1} << 20;

constexpr int kNoNode = -1;

/// A primitive as drawn by one node.
struct Part {
  int node = 0;
  int skin = -1;
  std::size_t mesh = 0;
  std::size_t primitive = 0;
  std::size_t vertex_count = 0;
  std::size_t corner_count = 0;  ///< number of indices, or of vertices if there are no indices
  std::vector<MorphTarget> targets;
};

std::string part_path(const Part& part, std::string_view property = {}) {
  return fmt::format("meshes[{}].primitives[{}]{}", part.mesh, part.primitive, property);
}

std::string attribute_path(const Part& part, std::string_view name) {
  return part_path(part, fmt::format(".attributes.{}", name));
}

std::size_t triangle_count(int mode, std::size_t corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

/// Whether an attribute is one of §3.7.2.1 or, with an underscore, the file's own.
bool is_known_attribute(std::string_view name) {
  constexpr std::array<std::string_view, 4> kNumbered = {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
  return name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.starts_with('_') ||
         std::any_of(kNumbered.begin(), kNumbered.end(), [&](auto prefix) { return name.starts_with(prefix); });
}

/// Whether the count of an attribute matters: others, such as normals and colours, are never read.
bool is_read(std::string_view name) {
  return name == "POSITION" || name == "TEXCOORD_0" || name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

std::uint32_t largest_index(int component_type) {
  if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return 0xFF;
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xFFFF : 0xFFFFFFFF;
}

class MeshReader {
 public:
  MeshReader(const Document& document, const std::vector<Skin>& skins, MorphTargets& morphs, Avatar& avatar,
             Report& report)
      : document_(document),
        skins_(skins),
        skin_palette_(skins.size()),
        morphs_(morphs),
        avatar_(avatar),
        report_(report) {
    world_matrices(avatar, rest_pose(avatar), world_);
  }

  /// Returns the parts that have triangles, in order of node and primitive.
  std::vector<Part> shown(const std::vector<bool>& drawn) {
    std::vector<Part> parts;
    for (std::size_t node = 0; node < drawn.size(); ++node) {
      const tinygltf::Node& source = document_.model.nodes[node];
      if (drawn[node] && source.mesh >= 0)
        collect(static_cast<std::size_t>(source.mesh), static_cast<int>(node), source.skin, parts);
    }
    return parts;
  }

  /// Returns the parts of a mesh that no node shows.
  std::vector<Part> unshown(std::size_t mesh) {
    std::vector<Part> parts;
    collect(mesh, kNoNode, -1, parts);
    return parts;
  }

  void read(const std::vector<Part>& parts, DrawnMeshes* details = nullptr) {
    reserve(parts);
    details_ = details;
    for (const Part& part : parts) {
      const auto [vertices, is_new] = first_vertex_.try_emplace(key(part), avatar_.position_bind.size());
      if (is_new) read_vertices(part);
      const std::size_t first_triangle = avatar_.triangles.size();
      read_triangles(part, vertices->second);
      if (details != nullptr)
        details->parts.push_back({part.node, part.skin, part.mesh, part.primitive, vertices->second, part.vertex_count,
                                  first_triangle, avatar_.triangles.size() - first_triangle, is_mirrored(part)});
      const auto displaces = [](const MorphTarget& target) { return target.displacement.has_value(); };
      if (part.node != kNoNode && std::any_of(part.targets.begin(), part.targets.end(), displaces))
        morphs_.add(part.node, {part.targets, vertices->second, part.vertex_count, part_path(part)});
    }
  }

 private:
  /// The key of a part's vertices: skin or node, attributes, and morph targets with their weights. Parts with the same
  /// key share their vertices.
  using Key =
      std::tuple<std::array<int, 2>, std::vector<std::pair<std::string, int>>, std::vector<std::pair<int, float>>>;

  const tinygltf::Primitive& primitive(const Part& part) const {
    return document_.model.meshes[part.mesh].primitives[part.primitive];
  }

  const Accessor& accessor(int index) const { return document_.accessors[static_cast<std::size_t>(index)]; }

  Key key(const Part& part) const {
    Key result = {{part.skin, part.skin < 0 ? part.node : -1}, {}, {}};
    auto& [follows, attributes, targets] = result;
    for (const auto& [name, index] : primitive(part).attributes)
      if (name == "POSITION" || name == "TEXCOORD_0" ||
          (part.skin >= 0 && (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_"))))
        attributes.emplace_back(name, index);
    for (const MorphTarget& target : part.targets)
      if (target.displacement && target.weight != 0) targets.emplace_back(*target.displacement, target.weight);
    return result;
  }

  void collect(std::size_t mesh, int node, int skin, std::vector<Part>& parts) {
    Part part;
    part.node = node;
    part.skin = skin;
    part.mesh = mesh;
    const std::size_t count = document_.model.meshes[mesh].primitives.size();
    for (part.primitive = 0; part.primitive < count; ++part.primitive)
      if (has_triangles(part)) parts.push_back(part);
  }

  bool has_triangles(Part& part) {
    const tinygltf::Primitive& source = primitive(part);
    if (source.mode < TINYGLTF_MODE_TRIANGLES) {
      report_.warn(part_path(part), "skipped points or lines");
      return false;
    }
    const auto position = source.attributes.find("POSITION");
    if (position == source.attributes.end()) {
      report_.warn(part_path(part), "skipped a primitive without POSITION");
      return false;
    }
    part.vertex_count = accessor(position->second).count;
    check_counts(part);
    part.targets = morphs_.at_rest(part.mesh, part.primitive, part.node);
    check_binding(part);
    part.corner_count = source.indices < 0 ? part.vertex_count : accessor(source.indices).count;
    if (triangle_count(source.mode, part.corner_count) == 0 ||
        (source.mode == TINYGLTF_MODE_TRIANGLES && part.corner_count % 3 != 0))
      report_.warn(part_path(part), "ignored corners that do not make a whole triangle");
    return triangle_count(source.mode, part.corner_count) > 0;
  }

  /// Checks that all attributes and morph targets have the same number of vertices.
  void check_counts(const Part& part) {
    const auto check = [&](const std::string& path, std::string_view name, int index) {
      if (accessor(index).count == part.vertex_count) return;
      if (!is_read(name)) return report_.warn(path, "does not have one element for each vertex, and is not read");
      report_.fail(path, fmt::format("has {} elements for {} vertices", accessor(index).count, part.vertex_count));
    };
    const tinygltf::Primitive& source = primitive(part);
    for (const auto& [name, index] : source.attributes) {
      check(attribute_path(part, name), name, index);
      if (!is_known_attribute(name)) report_.warn(attribute_path(part, name), "is not an attribute that glTF defines");
    }
    for (std::size_t i = 0; i < source.targets.size(); ++i)
      for (const auto& [name, index] : source.targets[i])
        check(part_path(part, fmt::format(".targets[{}].{}", i, name)), name, index);
  }

  void check_binding(const Part& part) {
    const bool has_joints = primitive(part).attributes.contains("JOINTS_0");
    if (part.skin >= 0 && !has_joints)
      report_.fail(part_path(part, ".attributes"),
                   fmt::format("has no JOINTS_0, but nodes[{}] shows it with skins[{}]", part.node, part.skin));
    if (part.skin < 0 && part.node != kNoNode && has_joints)
      report_.warn(part_path(part, ".attributes"), "has joints, but is shown without a skin");
  }

  void reserve(const std::vector<Part>& parts) {
    const std::size_t most_vertices = std::min(kMostVertices, kMostRepeated + document_.data_bytes);
    const std::size_t most_triangles = std::min(kMostTriangles, 2 * kMostRepeated + document_.data_bytes);
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::map<Key, bool> seen;
    for (const Part& part : parts) {
      if (seen.try_emplace(key(part), true).second) vertices += part.vertex_count;
      triangles += triangle_count(primitive(part).mode, part.corner_count);
      if (vertices > most_vertices || triangles > most_triangles)
        report_.fail(
            part_path(part),
            fmt::format("brings the avatar to more than {} vertices or {} triangles", most_vertices, most_triangles),
            "simplify the mesh");
    }
    avatar_.position_bind.reserve(vertices);
    avatar_.texture_coordinate.reserve(vertices);
    avatar_.influences.reserve(vertices);
    avatar_.triangles.reserve(triangles);
  }

  AccessorReader attribute(const Part& part, const std::string& name, const Format& format) {
    const auto found = primitive(part).attributes.find(name);
    const std::string path = attribute_path(part, name);
    if (found == primitive(part).attributes.end()) report_.fail(path, "is missing");
    AccessorReader reader(document_, found->second, format, path, report_);
    reader.check_vertex_alignment(report_);
    return reader;
  }

  void read_vertices(const Part& part) {
    const Format format = position_format(document_);
    const AccessorReader position = attribute(part, "POSITION", format);
    position.compare_bounds(report_);
    const std::size_t first = avatar_.position_bind.size();
    for (std::size_t i = 0; i < part.vertex_count; ++i)
      avatar_.position_bind.emplace_back(position.finite(i, 0), position.finite(i, 1), position.finite(i, 2));
    morphs_.bake(part.targets, part_path(part), std::span(avatar_.position_bind).subspan(first));
    if (primitive(part).attributes.contains("TEXCOORD_0")) {
      const AccessorReader uv =
          attribute(part, "TEXCOORD_0", {TINYGLTF_TYPE_VEC2, format.components | kNormalizedUint8 | kNormalizedUint16});
      for (std::size_t i = 0; i < part.vertex_count; ++i)
        avatar_.texture_coordinate.emplace_back(uv.finite(i, 0), uv.finite(i, 1));
    } else {
      avatar_.texture_coordinate.resize(avatar_.position_bind.size(), glm::vec2(0));
    }
    if (part.skin >= 0)
      read_influences(part);
    else
      follow_node(part);
  }

  void follow_node(const Part& part) {
    Influences rigid;
    rigid.palette[0] = palette_index(part.node, glm::dmat4(1.0), part);
    rigid.weight[0] = 1;
    avatar_.influences.resize(avatar_.position_bind.size(), rigid);
    if (details_ != nullptr) details_->weights.resize(avatar_.position_bind.size(), rigid.weight);
  }

  /// Keeps the weights that `combine_influences` has left.
  void keep_weights(const std::vector<Influence>& influences) {
    std::array<float, kMaxInfluences> weights = {};
    for (std::size_t i = 0; i < influences.size(); ++i) weights[i] = static_cast<float>(influences[i].weight);
    details_->weights.push_back(weights);
  }

  bool is_mirrored(const Part& part) const {
    return part.skin < 0 && part.node != kNoNode &&
           glm::determinant(glm::dmat3(world_[static_cast<std::size_t>(part.node)])) < 0;
  }

  /// One pair of attributes, JOINTS_n and WEIGHTS_n.
  struct InfluenceSet {
    AccessorReader joints;
    AccessorReader weights;
    std::string joints_path;
    std::string weights_path;
  };

  std::vector<InfluenceSet> influence_sets(const Part& part) {
    std::vector<InfluenceSet> sets;
    const auto& attributes = primitive(part).attributes;
    for (std::size_t n = 0;; ++n) {
      const std::string joints = fmt::format("JOINTS_{}", n);
      const std::string weights = fmt::format("WEIGHTS_{}", n);
      if (!attributes.contains(joints) && !attributes.contains(weights)) break;
      sets.push_back({attribute(part, joints, {TINYGLTF_TYPE_VEC4, kUint8 | kUint16}),
                      attribute(part, weights, {TINYGLTF_TYPE_VEC4, kFloat | kNormalizedUint8 | kNormalizedUint16}),
                      attribute_path(part, joints), attribute_path(part, weights)});
    }
    for (const std::string_view prefix : {"JOINTS_", "WEIGHTS_"}) {
      const auto count = std::count_if(attributes.begin(), attributes.end(),
                                       [&](const auto& attribute) { return attribute.first.starts_with(prefix); });
      if (static_cast<std::size_t>(count) != sets.size())
        report_.fail(part_path(part, ".attributes"),
                     fmt::format("has {}n whose numbers do not count up from 0", prefix));
    }
    return sets;
  }

  void read_influences(const Part& part) {
    const std::vector<InfluenceSet> sets = influence_sets(part);
    const std::vector<std::uint16_t>& palette = skin_palette(part);
    std::vector<Influence> influences;
    for (std::size_t vertex = 0; vertex < part.vertex_count; ++vertex) {
      influences.clear();
      for (const InfluenceSet& set : sets)
        for (std::size_t c = 0; c < 4; ++c) {
          const std::uint32_t joint = set.joints.integer(vertex, c);
          const auto weight = double{set.weights.finite(vertex, c)};
          if (weight < 0)
            report_.fail(set.weights_path, fmt::format("vertex {} has the negative weight {}", vertex, weight));
          if (joint >= palette.size() && weight > 0)
            report_.fail(set.joints_path, fmt::format("vertex {} names joint {}, but skins[{}] has only {}", vertex,
                                                      joint, part.skin, palette.size()));
          if (joint >= palette.size()) {
            report_.warn(set.joints_path, "names joints that do not exist; their weight is 0");
            continue;
          }
          if (weight > 0 && std::any_of(influences.begin(), influences.end(), [&](const Influence& other) {
                return other.palette == palette[joint] && other.weight > 0;
              }))
            report_.warn(set.joints_path, "names a joint twice for one vertex; the weights are added");
          influences.push_back({palette[joint], weight});
        }
      const std::uint16_t first = influences.empty() ? palette.front() : influences.front().palette;
      avatar_.influences.push_back(combine_influences(influences, first, sets.front().weights_path, report_));
      avatar_.influence_count = std::max(avatar_.influence_count, influences.size());
      if (details_ != nullptr) keep_weights(influences);
    }
  }

  const std::vector<std::uint16_t>& skin_palette(const Part& part) {
    const Skin& skin = skins_[static_cast<std::size_t>(part.skin)];
    std::vector<std::uint16_t>& palette = skin_palette_[static_cast<std::size_t>(part.skin)];
    if (palette.empty())
      for (std::size_t joint = 0; joint < skin.joints.size(); ++joint)
        palette.push_back(palette_index(skin.joints[joint], skin.inverse_bind[joint], part));
    return palette;
  }

  std::uint16_t palette_index(int node, const glm::dmat4& inverse_bind, const Part& part) {
    std::pair<int, std::array<double, 16>> entry = {node, {}};
    for (std::size_t i = 0; i < 16; ++i)
      entry.second[i] = inverse_bind[static_cast<int>(i / 4)][static_cast<int>(i % 4)];
    const auto [found, is_new] = palette_.try_emplace(entry, avatar_.palette.size());
    if (is_new) {
      if (avatar_.palette.size() > std::numeric_limits<std::uint16_t>::max())
        report_.fail(part_path(part), "brings the avatar to more than 65536 joints and rigid nodes",
                     "simplify the rig");
      avatar_.palette.push_back({node, inverse_bind});
    }
    return static_cast<std::uint16_t>(found->second);
  }

  /// glTF 2.0 §3.7.2.1: how the corners of strips and fans form triangles. §3.7.4: if the node mirrors a triangle, its
  /// front is the clockwise side. Skinned meshes ignore their node.
  void read_triangles(const Part& part, std::size_t first_vertex) {
    const tinygltf::Primitive& source = primitive(part);
    std::vector<std::uint32_t> corners(part.corner_count);
    if (source.indices < 0) {
      for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
    } else {
      const std::string path = part_path(part, ".indices");
      const AccessorReader indices(document_, source.indices, {TINYGLTF_TYPE_SCALAR, kUint8 | kUint16 | kUint32}, path,
                                   report_);
      const std::uint32_t restart = largest_index(accessor(source.indices).component_type);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = indices.integer(i, 0);
        if (corners[i] == restart)
          report_.fail(path, fmt::format("index {} is {}, which restarts a primitive and is not allowed", i, restart));
        if (corners[i] >= part.vertex_count)
          report_.fail(path,
                       fmt::format("index {} is {}, but there are {} vertices", i, corners[i], part.vertex_count));
      }
    }
    const bool mirrors = is_mirrored(part);
    const std::size_t count = triangle_count(source.mode, corners.size());
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::size_t, 3> at = {3 * i, 3 * i + 1, 3 * i + 2};
      if (source.mode == TINYGLTF_MODE_TRIANGLE_STRIP) at = {i, i + 1 + i % 2, i + 2 - i % 2};
      if (source.mode == TINYGLTF_MODE_TRIANGLE_FAN) at = {i + 1, i + 2, 0};
      if (mirrors) std::swap(at[1], at[2]);
      const glm::uvec3 triangle(corners[at[0]], corners[at[1]], corners[at[2]]);
      avatar_.triangles.push_back(triangle + static_cast<std::uint32_t>(first_vertex));
    }
  }

  const Document& document_;
  const std::vector<Skin>& skins_;
  std::vector<std::vector<std::uint16_t>> skin_palette_;  ///< for each skin's joints, once the skin is drawn
  std::vector<glm::dmat4> world_;                         ///< of each node, in the rest pose
  std::map<std::pair<int, std::array<double, 16>>, std::size_t> palette_;
  std::map<Key, std::size_t> first_vertex_;
  DrawnMeshes* details_ = nullptr;
  MorphTargets& morphs_;
  Avatar& avatar_;
  Report& report_;
};

}  // namespace

MorphTargets read_meshes(const Document& document, const std::vector<Skin>& skins, const std::vector<bool>& drawn,
                         Avatar& avatar, Report& report, DrawnMeshes* details) {
  MorphTargets morphs(document, report);
  MeshReader reader(document, skins, morphs, avatar, report);
  reader.read(reader.shown(drawn), details);

  std::vector<bool> is_shown(document.model.meshes.size());
  for (std::size_t node = 0; node < drawn.size(); ++node)
    if (const int mesh = document.model.nodes[node].mesh; drawn[node] && mesh >= 0)
      is_shown[static_cast<std::size_t>(mesh)] = true;
  for (std::size_t mesh = 0; mesh < is_shown.size(); ++mesh) {
    if (is_shown[mesh]) continue;
    Avatar unseen;
    MeshReader checker(document, skins, morphs, unseen, report);
    checker.read(checker.unshown(mesh));
  }
  return morphs;
}

}  // namespace vestige::gltf
