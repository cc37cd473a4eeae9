#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "detector/gl/gl_objects.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// An avatar's vertices and triangles in a context, with the attributes of shaders/constants.h. The mesh belongs to the
/// context whose functions it was made with. That context must be current at every call.
class SkinnedMesh {
 public:
  SkinnedMesh(const GlFunctions& gl, const Avatar& avatar);
  ~SkinnedMesh();
  SkinnedMesh(const SkinnedMesh&) = delete;
  SkinnedMesh& operator=(const SkinnedMesh&) = delete;

  void bind() const;

  /// Draws all triangles. The mesh must be bound.
  void draw(GLsizei instances) const;

  /// Draws `count` triangles from number `first` on, once. The mesh must be bound. gl_PrimitiveIDIn counts from 0.
  void draw_range(std::size_t first, std::size_t count) const;

  /// Runs the current program over all vertices and reads back its transform feedback. The program must be linked to
  /// capture one vec3. Some framebuffer must be bound: a draw without one fails in a surfaceless context.
  void capture(std::vector<glm::vec3>& out);

 private:
  void add_attribute(GLuint location, GLint components, GLenum type, std::size_t offset) const;

  const GlFunctions& gl_;
  std::size_t vertex_count_;
  GLsizei index_count_;
  GlBuffer vertices_;
  GlBuffer indices_;
  GlBuffer captured_;
  GLuint vertex_array_ = 0;
};

}  // namespace vestige
