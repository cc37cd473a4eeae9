#include "detector/gl/skinned_mesh.hpp"

#include <cstdint>
#include <glm/vec2.hpp>

#include "shaders/constants.h"

namespace vestige {

namespace {

struct GpuVertex {
  glm::vec3 position_bind;
  glm::vec2 texture_coordinate;
  Influences influences;
};

}  // namespace

SkinnedMesh::SkinnedMesh(const GlFunctions& gl, const Avatar& avatar)
    : gl_(gl),
      vertex_count_(avatar.position_bind.size()),
      index_count_(static_cast<GLsizei>(avatar.triangles.size() * 3)),
      vertices_(gl),
      indices_(gl),
      captured_(gl) {
  std::vector<GpuVertex> vertices(vertex_count_);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    vertices[i] = {avatar.position_bind[i], avatar.texture_coordinate[i], avatar.influences[i]};
  vertices_.upload(vertices.data(), vertices.size() * sizeof(GpuVertex), GL_STATIC_DRAW);
  indices_.upload(avatar.triangles.data(), avatar.triangles.size() * sizeof(glm::uvec3), GL_STATIC_DRAW);

  gl_.CreateVertexArrays(1, &vertex_array_);
  gl_.VertexArrayVertexBuffer(vertex_array_, 0, vertices_.name(), 0, sizeof(GpuVertex));
  gl_.VertexArrayElementBuffer(vertex_array_, indices_.name());
  const std::size_t palette = offsetof(GpuVertex, influences) + offsetof(Influences, palette);
  const std::size_t weight = offsetof(GpuVertex, influences) + offsetof(Influences, weight);
  add_attribute(VESTIGE_ATTRIBUTE_POSITION, 3, GL_FLOAT, offsetof(GpuVertex, position_bind));
  add_attribute(VESTIGE_ATTRIBUTE_TEXTURE_COORDINATE, 2, GL_FLOAT, offsetof(GpuVertex, texture_coordinate));
  add_attribute(VESTIGE_ATTRIBUTE_PALETTE_0, 4, GL_UNSIGNED_SHORT, palette);
  add_attribute(VESTIGE_ATTRIBUTE_WEIGHT_0, 4, GL_FLOAT, weight);
  if (avatar.influence_count <= 4) return;
  add_attribute(VESTIGE_ATTRIBUTE_PALETTE_1, 4, GL_UNSIGNED_SHORT, palette + 4 * sizeof(std::uint16_t));
  add_attribute(VESTIGE_ATTRIBUTE_WEIGHT_1, 4, GL_FLOAT, weight + 4 * sizeof(float));
}

SkinnedMesh::~SkinnedMesh() {
  gl_.DeleteVertexArrays(1, &vertex_array_);
}

void SkinnedMesh::bind() const {
  gl_.BindVertexArray(vertex_array_);
}

void SkinnedMesh::draw(GLsizei instances) const {
  gl_.DrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr, instances);
}

void SkinnedMesh::draw_range(std::size_t first, std::size_t count) const {
  // OpenGL takes the offset in the index buffer as a pointer.
  const auto* offset = reinterpret_cast<const void*>(first * sizeof(glm::uvec3));  // NOLINT(performance-no-int-to-ptr)
  gl_.DrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT, offset, 1);
}

void SkinnedMesh::capture(std::vector<glm::vec3>& out) {
  out.resize(vertex_count_);
  const std::size_t bytes = out.size() * sizeof(glm::vec3);
  captured_.upload(nullptr, bytes, GL_STREAM_READ);
  gl_.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured_.name());
  bind();
  gl_.BeginTransformFeedback(GL_POINTS);
  gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(out.size()));
  gl_.EndTransformFeedback();
  gl_.GetNamedBufferSubData(captured_.name(), 0, static_cast<GLsizeiptr>(bytes), out.data());
}

void SkinnedMesh::add_attribute(GLuint location, GLint components, GLenum type, std::size_t offset) const {
  gl_.EnableVertexArrayAttrib(vertex_array_, location);
  gl_.VertexArrayAttribBinding(vertex_array_, location, 0);
  if (type == GL_FLOAT) {
    gl_.VertexArrayAttribFormat(vertex_array_, location, components, type, GL_FALSE, static_cast<GLuint>(offset));
  } else {
    gl_.VertexArrayAttribIFormat(vertex_array_, location, components, type, static_cast<GLuint>(offset));
  }
}

}  // namespace vestige
