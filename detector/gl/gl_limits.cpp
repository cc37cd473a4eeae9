#include "detector/gl/gl_limits.hpp"

#include <array>

#include "detector/gl/collision_texture.hpp"

namespace vestige {

namespace {

struct Row {
  GLenum name;
  GlLimit limit;
};

constexpr std::int64_t kPlanes = kGlPlanes.size();

constexpr std::array<Row, 11> kRows = {{
    {GL_MAX_GEOMETRY_OUTPUT_VERTICES, {"geometry_output_vertices", "points from a geometry shader", 0, 1}},
    {GL_MAX_GEOMETRY_TOTAL_OUTPUT_COMPONENTS, {"geometry_output_components", "components in all points", 0, 16}},
    {GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, {"vertex_storage_blocks", "storage blocks, vertex shader", 0, 1}},
    {GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS, {"geometry_storage_blocks", "storage blocks, geometry shader", 0, 1}},
    {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, {"storage_bindings", "storage buffer bindings", 0, 8}},
    {GL_MAX_SHADER_STORAGE_BLOCK_SIZE, {"storage_block_bytes", "bytes of a storage block", 0, 0}},
    {GL_MAX_TEXTURE_SIZE, {"texture_side", "texels along a texture", 0, 0}},
    {GL_MAX_VIEWPORT_DIMS, {"viewport_width", "pixels along a viewport", 0, 0}},
    {GL_MAX_COLOR_ATTACHMENTS, {"colour_attachments", "colour attachments", 0, kPlanes}},
    {GL_MAX_DRAW_BUFFERS, {"draw_buffers", "draw buffers", 0, kPlanes}},
    {GL_MAX_TRANSFORM_FEEDBACK_INTERLEAVED_COMPONENTS,
     {"transform_feedback_components", "transform feedback components", 0, 3}},
}};

}  // namespace

std::vector<GlLimit> gl_limits(GlContext& context) {
  context.make_current();
  std::vector<GlLimit> limits;
  for (const Row& row : kRows) {
    std::array<GLint64, 2> value = {};  // a viewport has two
    context.gl().GetInteger64v(row.name, value.data());
    limits.push_back(row.limit);
    limits.back().value = value[0];
  }
  return limits;
}

}  // namespace vestige
