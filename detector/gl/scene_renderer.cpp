#include "detector/gl/scene_renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <utility>

#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

enum class Drawn { kSkin, kColliders };

std::string head(const Avatar& avatar, Drawn drawn) {
  return fmt::format("#version 450 core\n{}#define INFLUENCES {}\n#define COLLIDERS {}\n", shaders::kConstantsH,
                     avatar.influence_count, drawn == Drawn::kColliders ? 1 : 0);
}

constexpr std::array<float, 4> kBackground = {0.93F, 0.94F, 0.95F, 1.0F};

}  // namespace

SceneRenderer::SceneRenderer(std::unique_ptr<GlContext> context, const Avatar& avatar)
    : context_(std::move(context)),
      gl_(current_gl(*context_)),
      avatar_(avatar),
      mesh_(gl_, avatar),
      palette_(gl_),
      points_(gl_),
      skin_program_(gl_, head(avatar, Drawn::kSkin),
                    {{GL_VERTEX_SHADER, "scene.vert", shaders::kSceneVert},
                     {GL_FRAGMENT_SHADER, "scene.frag", shaders::kSceneFrag}}),
      collider_program_(gl_, head(avatar, Drawn::kColliders),
                        {{GL_VERTEX_SHADER, "scene.vert", shaders::kSceneVert},
                         {GL_FRAGMENT_SHADER, "scene.frag", shaders::kSceneFrag}}) {
  aim_camera();
  make_framebuffer();
  make_collider_points();
  for (const GlProgram* program : {&skin_program_, &collider_program_})
    gl_.ProgramUniformMatrix4fv(program->name(), VESTIGE_UNIFORM_WORLD_TO_CLIP, 1, GL_FALSE, &world_to_clip_[0][0]);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.Enable(GL_PROGRAM_POINT_SIZE);
  gl_.DepthFunc(GL_LESS);
  check_gl(gl_, "preparing to draw the scene");
}

SceneRenderer::~SceneRenderer() {
  try {
    context_->make_current();
    gl_.DeleteVertexArrays(1, &point_array_);
    gl_.DeleteFramebuffers(1, &framebuffer_);
    gl_.DeleteRenderbuffers(1, &colour_);
    gl_.DeleteRenderbuffers(1, &depth_);
  } catch (const Error&) {
    // The context is lost, together with everything in it.
  }
}

void SceneRenderer::draw(const TraceFrame& frame) {
  context_->make_current();
  world_matrices(avatar_, frame.poses.front(), world_);
  const glm::dvec3 root(world_[static_cast<std::size_t>(avatar_.root_node)][3]);
  build_palette(avatar_, world_, -root, palette_matrices_);
  palette_.upload(palette_matrices_.data(), palette_matrices_.size() * sizeof(SkinMatrix), GL_STREAM_DRAW);
  collider_positions_.clear();
  collider_positions_.reserve(frame.colliders.size());
  for (const ColliderSample& collider : frame.colliders)
    collider_positions_.emplace_back(collider.position_m - frame.poses.front().origin_m - root);
  points_.upload(collider_positions_.data(), collider_positions_.size() * sizeof(glm::vec3), GL_STREAM_DRAW);

  constexpr GLfloat kFar = 1;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, kWidth, kHeight);
  gl_.ClearNamedFramebufferfv(framebuffer_, GL_COLOR, 0, kBackground.data());
  gl_.ClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &kFar);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_PALETTE, palette_.name());
  gl_.UseProgram(skin_program_.name());
  mesh_.bind();
  mesh_.draw(1);
  if (!collider_positions_.empty()) {
    gl_.UseProgram(collider_program_.name());
    gl_.BindVertexArray(point_array_);
    gl_.VertexArrayVertexBuffer(point_array_, 0, points_.name(), 0, sizeof(glm::vec3));
    gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(collider_positions_.size()));
  }
  gl_.Finish();
  check_gl(gl_, "drawing the scene");
}

std::vector<std::uint8_t> SceneRenderer::pixels() {
  context_->make_current();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  std::vector<std::uint8_t> pixels(std::size_t{4} * kWidth * kHeight);
  gl_.ReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  check_gl(gl_, "reading the scene back");
  return pixels;
}

/// Looks from the front, far enough away to see the rest pose and a moving limb beside it.
void SceneRenderer::aim_camera() {
  world_matrices(avatar_, rest_pose(avatar_), world_);
  const glm::dvec3 root(world_[static_cast<std::size_t>(avatar_.root_node)][3]);
  build_palette(avatar_, world_, -root, palette_matrices_);
  std::vector<glm::vec3> skin;
  skin_vertices(avatar_, palette_matrices_, skin);
  glm::vec3 low(0);
  glm::vec3 high(0);
  for (const glm::vec3& vertex : skin) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const glm::vec3 centre = 0.5F * (low + high);
  const float size_m = std::max(glm::length(high - low), 1e-3F);
  const glm::vec3 towards(turned_from_front({0, 0.1, 1.4}, avatar_.facing.axis));
  const glm::mat4 view = glm::lookAt(centre + towards * size_m, centre, glm::vec3(0, 1, 0));
  constexpr float kAspect = static_cast<float>(kWidth) / static_cast<float>(kHeight);
  world_to_clip_ = glm::perspective(glm::radians(45.0F), kAspect, 0.1F * size_m, 10 * size_m) * view;
}

void SceneRenderer::make_framebuffer() {
  gl_.CreateFramebuffers(1, &framebuffer_);
  gl_.CreateRenderbuffers(1, &colour_);
  gl_.CreateRenderbuffers(1, &depth_);
  gl_.NamedRenderbufferStorage(colour_, GL_RGBA8, kWidth, kHeight);
  gl_.NamedRenderbufferStorage(depth_, GL_DEPTH_COMPONENT32F, kWidth, kHeight);
  gl_.NamedFramebufferRenderbuffer(framebuffer_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  gl_.NamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  const GLenum status = gl_.CheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error("OpenGL",
                fmt::format("the driver refuses a framebuffer of {} x {} (status {:#06x})", kWidth, kHeight, status),
                "use another --context");
}

void SceneRenderer::make_collider_points() {
  gl_.CreateVertexArrays(1, &point_array_);
  gl_.EnableVertexArrayAttrib(point_array_, VESTIGE_ATTRIBUTE_POSITION);
  gl_.VertexArrayAttribBinding(point_array_, VESTIGE_ATTRIBUTE_POSITION, 0);
  gl_.VertexArrayAttribFormat(point_array_, VESTIGE_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, 0);
}

}  // namespace vestige
