#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// One morph target of a primitive (glTF 2.0 §3.7.2.2).
struct MorphTarget {
  std::optional<int> displacement;  ///< the accessor of its POSITION; if empty, it moves no vertex
  float weight = 0;                 ///< at rest
};

/// A primitive with morph targets, as shown by a node: its vertices are `vertex_count` ones of the avatar.
struct MorphedPart {
  std::vector<MorphTarget> targets;
  std::size_t first_vertex = 0;
  std::size_t vertex_count = 0;
  std::string path;  ///< of the primitive
};

/// The morph targets of an avatar. Keeps references to the document and the report. All functions fail if a
/// displacement is not finite, or if targets or displacements are far more than the bytes of the file.
class MorphTargets {
 public:
  MorphTargets(const Document& document, Report& report) : document_(document), report_(report) {}

  /// Returns the targets of a primitive, with the weights at rest of the node that shows it. These are the node's own
  /// weights, otherwise the mesh's, otherwise 0. `node` is -1 if no node shows the mesh. Fails if the number of weights
  /// is not that of the targets; warns of that if the primitive has no targets or the weights are all 0.
  std::vector<MorphTarget> at_rest(std::size_t mesh, std::size_t primitive, int node);

  /// Displaces positions by the weights at rest. The sum is computed in double and rounded once.
  void bake(const std::vector<MorphTarget>& targets, const std::string& path, std::span<glm::vec3> positions);

  void add(int node, MorphedPart part) { parts_[node].push_back(std::move(part)); }

  /// Returns the number of weights that an animation of this node has for each key. It is 0 if the node shows no target
  /// that moves a vertex. Fails if its primitives differ in their number of targets.
  std::size_t weight_count(int node) const;

  /// Returns how far an animation of the node's weights displaces a vertex from its place at rest, in metres. This is
  /// an upper bound: it adds the largest displacements by all targets, in the rest pose. Returns nothing if no vertex
  /// ever moves. `weights` has `weight_count(node)` values a key.
  std::optional<double> reach_m(int node, const AnimationChannel& weights, const Avatar& avatar);

 private:
  /// Returns a target's displacements, one for each vertex.
  std::vector<glm::dvec3> displacements(const MorphTarget& target, const std::string& path, std::size_t vertex_count);

  const Document& document_;
  Report& report_;
  std::map<int, std::vector<MorphedPart>> parts_;  ///< by node
  std::size_t target_count_ = 0;                   ///< returned so far
  std::size_t read_ = 0;                           ///< displacements so far
};

}  // namespace vestige::gltf
