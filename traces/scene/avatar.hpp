#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "traces/scene/facing.hpp"
#include "traces/scene/humanoid.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

/// Most joints that one vertex can have (glTF's JOINTS_0 and JOINTS_1).
inline constexpr std::size_t kMaxInfluences = 8;

/// One node of the skeleton tree. Its rest transform is `rest`, or `fixed_matrix` if the glTF `matrix` is not a product
/// of translation, rotation and scale. A node with `fixed_matrix` cannot be animated and ignores the pose.
struct Node {
  std::string name;
  int parent = -1;  ///< index of a node, -1 for a root
  NodeLocal rest;
  std::optional<glm::dmat4> fixed_matrix;
};

/// One matrix of the palette that vertices refer to: the node's world matrix times `inverse_bind`. A skin contributes
/// one entry for each of its joints. A mesh without a skin contributes its node, with the identity as `inverse_bind`.
struct PaletteEntry {
  int node = 0;
  glm::dmat4 inverse_bind = glm::dmat4(1.0);
};

/// Joints and weights of a vertex: sorted by palette index, with equal joints merged. Weights are > 0, normalised in
/// double and then rounded once. Unused entries are {0, 0}. See detector/CONTRACT.md, 3.
struct Influences {
  std::array<std::uint16_t, kMaxInfluences> palette = {};
  std::array<float, kMaxInfluences> weight = {};
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class AnimatedProperty { kTranslation, kRotation, kScale };

/// glTF 2.0, Appendix C. `values` holds 3 floats a key, or 4 for a rotation (x y z w). For kCubicSpline it holds three
/// times as many (in-tangent, value, out-tangent).
struct AnimationChannel {
  int node = 0;
  AnimatedProperty property = AnimatedProperty::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;  ///< strictly increasing, not negative
  std::vector<float> values;
};

/// Motion of the skin by morph targets, which is not played.
struct MorphMotion {
  std::string where;   ///< file and first channel that moves the skin so, for messages
  double reach_m = 0;  ///< how far a vertex departs from its place at rest: an upper bound, for the rest pose
};

struct Animation {
  std::string name;  ///< may be empty: glTF does not require one
  double duration_s = 0;
  std::vector<AnimationChannel> channels;
  std::optional<MorphMotion> morph = {};
};

/// A skinned, animated triangle mesh: exactly those parts of a glTF file that detection reads.
struct Avatar {
  std::vector<Node> nodes;      ///< in the file's order
  std::vector<int> node_order;  ///< every node once, parents before children
  std::vector<PaletteEntry> palette;
  int root_node = 0;  ///< the node whose world position is the avatar's position (origin rule)

  // Vertices, one entry each.
  std::vector<glm::vec3> position_bind;
  std::vector<glm::vec2> texture_coordinate;  ///< TEXCOORD_0, (0, 0) where the file has none
  std::vector<Influences> influences;
  std::size_t influence_count = 1;  ///< the most that any vertex has, 1 … 8

  /// In the order of node, primitive and index, including duplicate and degenerate triangles. Counter-clockwise seen
  /// from the front, in the rest pose.
  std::vector<glm::uvec3> triangles;
  std::vector<Animation> animations;
  Humanoid humanoid;                  ///< the bones of a human body
  AvatarFacing facing;                ///< in the rest pose
  std::size_t joint_count = 0;        ///< distinct joints over all skins
  std::vector<std::string> warnings;  ///< oddities of the file that do no harm, one sentence each
};

}  // namespace vestige
