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
  bind();
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

void CollisionTexture::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
}

std::size_t CollisionTexture::values_of(std::size_t plane_index) const {
  const GlPlane& plane = kGlPlanes[plane_index];
  if (!planes_.has(plane.plane)) return 0;
  return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * plane.components;
}

void CollisionTexture::read() {
  std::size_t values = 0;
  for (std::size_t i = 0; i < kGlPlanes.size(); ++i) values += values_of(i);
  if (read_.size() != values) pixels_.upload(nullptr, values * sizeof(std::uint32_t), GL_STREAM_READ);
  read_.resize(values);
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.name());
  std::uintptr_t offset = 0;
  for (std::size_t i = 0; i < kGlPlanes.size(); ++i) {
    const GlPlane& plane = kGlPlanes[i];
    if (!planes_.has(plane.plane)) continue;
    gl_.NamedFramebufferReadBuffer(framebuffer_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    gl_.ReadPixels(0, 0, width_, height_, plane.format, plane.plane == Plane::kTriangle ? GL_UNSIGNED_INT : GL_FLOAT,
                   reinterpret_cast<void*>(offset));  // NOLINT(performance-no-int-to-ptr): OpenGL takes it so
    offset += values_of(i) * sizeof(std::uint32_t);
  }
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl_.GetNamedBufferSubData(pixels_.name(), 0, static_cast<GLsizeiptr>(values * sizeof(std::uint32_t)), read_.data());
}

std::span<const std::uint32_t> CollisionTexture::texels(std::size_t plane_index) const {
  std::size_t first = 0;
  for (std::size_t i = 0; i < plane_index; ++i) first += values_of(i);
  return std::span(read_).subspan(first, values_of(plane_index));
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
