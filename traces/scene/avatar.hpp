#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "traces/scene/pose.hpp"

namespace vestige {

/// At most this many joints move one vertex (glTF's JOINTS_0 and JOINTS_1).
inline constexpr std::size_t kMaxInfluences = 8;

/// One node of the skeleton's tree. Its rest transform is `rest`, or `fixed_matrix` where a glTF `matrix` is no product
/// of translation, rotation and scale; such a node cannot be animated and ignores a pose.
struct Node {
  std::string name;
  int parent = -1;  ///< index of a node, -1 for a root
  NodeLocal rest;
  std::optional<glm::dmat4> fixed_matrix;
};

/// One matrix of the palette that vertices refer to: node's world matrix times `inverse_bind`. A skin contributes one
/// for each of its joints; a mesh without a skin contributes its node, with the identity.
struct PaletteEntry {
  int node = 0;
  glm::dmat4 inverse_bind = glm::dmat4(1.0);
};

/// What moves a vertex. Sorted by palette index, equal joints merged, weights > 0 normalised in double and then rounded
/// once; the rest of the array is {0, 0}. detector/CONTRACT.md, 3.
struct Influences {
  std::array<std::uint16_t, kMaxInfluences> palette = {};
  std::array<float, kMaxInfluences> weight = {};
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class AnimatedProperty { kTranslation, kRotation, kScale };

/// glTF 2.0, Appendix C. `values` holds 3 floats a key (4 for a rotation, x y z w), three times as many for
/// kCubicSpline (in-tangent, value, out-tangent).
struct AnimationChannel {
  int node = 0;
  AnimatedProperty property = AnimatedProperty::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;  ///< strictly increasing, not negative
  std::vector<float> values;
};

struct Animation {
  std::string name;  ///< may be empty: glTF does not require one
  double duration_s = 0;
  std::vector<AnimationChannel> channels;
};

/// A skinned, animated triangle mesh: everything that detection reads of a glTF file, and nothing else.
struct Avatar {
  std::vector<Node> nodes;      ///< in the file's order
  std::vector<int> node_order;  ///< every node once, parents before children
  std::vector<PaletteEntry> palette;
  int root_node = 0;  ///< whose world position says where the avatar is (origin rule)

  // Vertices, one entry each.
  std::vector<glm::vec3> position_bind;
  std::vector<glm::vec2> texture_coordinate;  ///< TEXCOORD_0, (0, 0) where the file has none
  std::vector<Influences> influences;
  std::size_t influence_count = 1;  ///< the most that any vertex has, 1 … 8

  /// In node, primitive, index order; duplicates and degenerate ones included. Counter-clockwise seen from the front,
  /// in the rest pose.
  std::vector<glm::uvec3> triangles;
  std::vector<Animation> animations;
  std::size_t joint_count = 0;        ///< distinct joints over all skins
  std::vector<std::string> warnings;  ///< what was odd in the file but did no harm, one sentence each
};

}  // namespace vestige
