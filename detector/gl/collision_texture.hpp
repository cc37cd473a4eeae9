#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/contact.hpp"
#include "detector/gl/gl_functions.hpp"
#include "detector/gl/gl_objects.hpp"
#include "shaders/constants.h"

namespace vestige {

/// A plane of the collision texture: the format of its attachment. Planes are attached in the order of their bits.
struct GlPlane {
  Plane plane;
  GLenum internal_format;
  GLenum format;
  std::size_t components;           ///< number of components in the read-back of each texel
  std::size_t geometry_components;  ///< number of components that the geometry shader writes for each point
};

inline constexpr std::array<GlPlane, 8> kGlPlanes = {{
    {Plane::kActuator, GL_R32F, GL_RED, 1, 1},
    {Plane::kTime, GL_R32F, GL_RED, 1, 1},
    {Plane::kTriangle, GL_R32UI, GL_RED_INTEGER, 1, 1},
    {Plane::kBarycentric, GL_RG32F, GL_RG, 2, 2},
    {Plane::kTextureCoordinate, GL_RG32F, GL_RG, 2, 2},
    {Plane::kPosition, GL_RGBA32F, GL_RGBA, 4, 3},
    {Plane::kSpeed, GL_R32F, GL_RED, 1, 1},
    {Plane::kSide, GL_R32F, GL_RED, 1, 1},
}};
static_assert(static_cast<unsigned>(Plane::kSide) == 1U << VESTIGE_PLANE_SIDE);

/// The collision texture (HAVE 2010 §III.A): one texel for each collider, in as many rows as the driver's texture limit
/// requires. A depth buffer keeps the earliest contact. The texture belongs to the context whose functions it was made
/// with. That context must be current at every call.
class CollisionTexture {
 public:
  CollisionTexture(const GlFunctions& gl, PlaneSet planes) : gl_(gl), planes_(planes), pixels_(gl) {}
  ~CollisionTexture() { release(); }
  CollisionTexture(const CollisionTexture&) = delete;
  CollisionTexture& operator=(const CollisionTexture&) = delete;

  GLsizei width() const { return width_; }
  GLsizei height() const { return height_; }

  /// Makes room for `texels`, binds the framebuffer and clears it to +inf, 0xFFFFFFFF and depth 1. Throws `Error` if a
  /// texture cannot hold that many texels, or if the driver refuses the planes.
  void begin(std::size_t texels);

  /// Binds the framebuffer of the last `begin` as it is.
  void bind() const;

  /// Reads all planes of the set back, and waits once for all of them. The result is valid until the next call.
  void read();
  /// What `read` read of the plane kGlPlanes[plane_index], which must be in the set: width * height * components values
  /// of 32 bits.
  std::span<const std::uint32_t> texels(std::size_t plane_index) const;

 private:
  void create(std::size_t texels);
  void release();
  std::size_t values_of(std::size_t plane_index) const;

  const GlFunctions& gl_;
  PlaneSet planes_;
  GLuint framebuffer_ = 0;
  GLuint depth_ = 0;
  std::array<GLuint, kGlPlanes.size()> textures_ = {};
  GLsizei width_ = 0;
  GLsizei height_ = 0;
  std::size_t texels_ = 0;
  GlBuffer pixels_;                  ///< of all planes, one after the other
  std::vector<std::uint32_t> read_;  ///< the same, as `read` left them
};

}  // namespace vestige
