#pragma once

#include <cstddef>
#include <map>
#include <span>

#include "traces/gltf/clean/glb_builder.hpp"
#include "traces/gltf/gltf_document.hpp"

namespace vestige::gltf {

/// Copies to a new file what detection does not read, but people or other verbs do: normals, colours, colour textures
/// in PNG or JPEG that lie in the file, the copyright, and the roles that VRM gives to nodes. Leaves out what is wrong.
class Look {
 public:
  /// Keeps references to `document`, which was loaded from `glb`, and to `builder`.
  Look(std::span<const std::byte> glb, const Document& document, GlbBuilder& builder);

  GlbBuilder::Json asset() const;
  void add_normals(GlbBuilder::Json& attributes, std::size_t mesh, std::size_t primitive, std::size_t vertex_count);
  void set_material(GlbBuilder::Json& primitive, std::size_t mesh, std::size_t index);
  /// Adds the roles of nodes.
  void finish();

 private:
  using Tree = GlbBuilder::Json;

  int add_material(const Tree& source);
  int add_texture(const Tree& material);

  Report report_;
  const Document& document_;
  Tree json_;  ///< all of the file's; null if it cannot be parsed
  GlbBuilder& builder_;
  std::map<std::size_t, int> material_of_;
  std::map<std::size_t, int> texture_of_;
};

}  // namespace vestige::gltf
