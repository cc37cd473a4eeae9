#include "detector/gl/collision_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "detector/gl/gl_objects.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// Returns the most pixels along a side of everything that the collision texture is made of or drawn through.
std::size_t largest_side(const GlFunctions& gl) {
  std::array<GLint, 2> viewport = {};
  gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return static_cast<std::size_t>(
      std::min({gl_limit(gl, GL_MAX_TEXTURE_SIZE), gl_limit(gl, GL_MAX_RENDERBUFFER_SIZE), viewport[0], viewport[1]}));
}

}  // namespace

void CollisionTexture::begin(std::size_t texels) {
  if (texels > texels_ || framebuffer_ == 0) create(texels);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr std::array<GLfloat, 4> kNone = {kInfinity, kInfinity, kInfinity, kInfinity};
  constexpr std::array<GLuint, 4> kNoIndex = {kNoTriangle, 0, 0, 0};
  constexpr GLfloat kFar = 1;
  for (GLint i = 0; i < static_cast<GLint>(kGlPlanes.size()); ++i) {
    const GlPlane& plane = kGlPlanes[static_cast<std::size_t>(i)];
    if (!planes_.has(plane.plane)) continue;
    if (plane.plane == Plane::kTriangle) {
      gl_.ClearNamedFramebufferuiv(framebuffer_, GL_COLOR, i, kNoIndex.data());
    } else {
      gl_.ClearNamedFramebufferfv(framebuffer_, GL_COLOR, i, kNone.data());
    }
  }
  gl_.ClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &kFar);
}

void CollisionTexture::read(std::size_t plane_index, std::vector<std::uint32_t>& out) const {
  const GlPlane& plane = kGlPlanes[plane_index];
  out.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * plane.components);
  gl_.NamedFramebufferReadBuffer(framebuffer_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(plane_index));
  gl_.ReadPixels(0, 0, width_, height_, plane.format, plane.plane == Plane::kTriangle ? GL_UNSIGNED_INT : GL_FLOAT,
                 out.data());
}

void CollisionTexture::create(std::size_t texels) {
  release();
  const std::size_t side = largest_side(gl_);
  const std::size_t wanted = std::max<std::size_t>(texels, 1);
  const std::size_t columns = std::min(wanted, side);
  const std::size_t rows = (wanted + columns - 1) / columns;
  if (rows > side)
    throw Error("OpenGL", fmt::format("{} colliders do not fit into a texture", texels), "use fewer colliders");
  width_ = static_cast<GLsizei>(columns);
  height_ = static_cast<GLsizei>(rows);
  texels_ = columns * rows;
  gl_.CreateFramebuffers(1, &framebuffer_);
  std::array<GLenum, kGlPlanes.size()> draw_buffers = {};
  for (std::size_t i = 0; i < kGlPlanes.size(); ++i) {
    draw_buffers[i] = GL_NONE;
    if (!planes_.has(kGlPlanes[i].plane)) continue;
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &textures_[i]);
    gl_.TextureStorage2D(textures_[i], 1, kGlPlanes[i].internal_format, width_, height_);
    gl_.NamedFramebufferTexture(framebuffer_, attachment, textures_[i], 0);
    draw_buffers[i] = attachment;
  }
  gl_.CreateRenderbuffers(1, &depth_);
  gl_.NamedRenderbufferStorage(depth_, GL_DEPTH_COMPONENT32F, width_, height_);
  gl_.NamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  gl_.NamedFramebufferDrawBuffers(framebuffer_, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
  const GLenum status = gl_.CheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return;
  release();
  throw Error("OpenGL", fmt::format("the driver refuses a collision texture (status {:#06x})", status),
              "ask for fewer planes, or use another --context");
}

void CollisionTexture::release() {
  if (framebuffer_ == 0) return;
  gl_.DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  gl_.DeleteRenderbuffers(1, &depth_);
  gl_.DeleteFramebuffers(1, &framebuffer_);
  textures_ = {};
  framebuffer_ = 0;
  texels_ = 0;
}

}  // namespace vestige
