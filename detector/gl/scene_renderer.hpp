#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/gl/skinned_mesh.hpp"
#include "detector/skinning.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Draws the view of a user of the scene into its own framebuffer: the avatar from the front, lit, and the colliders.
/// In HAVE 2010 §IV this runs beside the detection, in its own context and thread. Only the thread that made the
/// renderer may use it.
class SceneRenderer {
 public:
  static constexpr GLsizei kWidth = 800;
  static constexpr GLsizei kHeight = 600;

  /// Throws `Error` with the driver's own message if the driver refuses. Keeps a reference to the avatar.
  SceneRenderer(std::unique_ptr<GlContext> context, const Avatar& avatar);
  ~SceneRenderer();
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;

  const GlInfo& gl_info() const { return context_->info(); }

  /// Draws one frame, and returns when the drawing is finished.
  void draw(const TraceFrame& frame);

  /// Returns the last drawn image: kWidth * kHeight pixels of red, green, blue and alpha, the lowest row first.
  std::vector<std::uint8_t> pixels();

 private:
  void aim_camera();
  void make_framebuffer();
  void make_collider_points();

  std::unique_ptr<GlContext> context_;
  const GlFunctions& gl_;
  const Avatar& avatar_;
  SkinnedMesh mesh_;
  GlBuffer palette_;
  GlBuffer points_;
  GlProgram skin_program_;
  GlProgram collider_program_;
  GLuint point_array_ = 0;
  GLuint framebuffer_ = 0;
  GLuint colour_ = 0;
  GLuint depth_ = 0;
  glm::mat4 world_to_clip_ = glm::mat4(1);  ///< metres, relative to the avatar's root
  std::vector<glm::dmat4> world_;
  std::vector<SkinMatrix> palette_matrices_;
  std::vector<glm::vec3> collider_positions_;
};

}  // namespace vestige
