#include "detector/detectors/skipping_geometry_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/coherence/candidate_patches.hpp"
#include "detector/decision.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/gl/captured_pairs.hpp"
#include "detector/gl/collision_texture.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/skinning.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kBlockSlots = 256;
constexpr std::size_t kBlockSegments = 384;

/// std140 layout of the shader's Candidates: the input of one draw.
struct Slot {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t touched = 0;
  std::uint32_t offset = 0;
};
struct GpuSegment {
  glm::vec4 start;  ///< w: bounding_radius_m
  glm::vec4 end;
};
struct Block {
  std::array<Slot, kBlockSlots> slots;
  std::array<GpuSegment, kBlockSegments> segments;
};
static_assert(sizeof(Block) ==
              16384);  // the size that every driver allows for a uniform block (GL_MAX_UNIFORM_BLOCK_SIZE)

/// The slots and segments that one draw tests. A slot is a meshlet with all of its triangles.
struct Draw {
  std::size_t first_slot = 0;  ///< number of its first slot in the frame
  std::size_t slots = 0;
  std::size_t segments = 0;
};

/// Tests the segments of a frame against the meshlets that they may meet. A frame without such a pair needs no OpenGL
/// call. Otherwise the CPU skins only those meshlets and uploads them: a point for each triangle, with the corners as
/// attributes. The geometry shader finds the segments by the number of the primitive, in a uniform block.
///
/// Measured on llvmpipe, processor time per frame, 40 and 100 colliders of a swarm, all axes of geometry.geom: one
/// indirect draw command for each meshlet, skinned by the vertex shader, 236 and 418 us; one draw with the touched
/// meshlets' indices, 214 and 477 us; this design, skinned by the CPU, 162 and 290 us; with a box and a slab alone, 67
/// and 145 us. A storage buffer instead of the uniform block took 15 % longer. A persistently mapped buffer saved less
/// than 2 us.
class SkippingGeometryDetector final : public Detector {
 public:
  SkippingGeometryDetector(std::shared_ptr<GlContext> context, const Avatar& avatar, const ActuatorMap& map,
                           const DetectorOptions& options)
      : context_(std::move(context)),
        gl_(current_gl(*context_)),
        avatar_(avatar),
        method_(options.method),
        finder_(avatar, map, options),
        meshlets_(avatar),
        candidates_(avatar, meshlets_, options.method),
        corners_(gl_),
        blocks_(gl_),
        captured_(gl_),
        nowhere_(gl_, PlaneSet()),
        program_(gl_, head(),
                 {{GL_VERTEX_SHADER, "candidates.vert", shaders::kCandidatesVert},
                  {GL_GEOMETRY_SHADER, "candidates.geom", shaders::kCandidatesGeom}}) {
    gl_.CreateVertexArrays(1, &vertex_array_);
    gl_.VertexArrayVertexBuffer(vertex_array_, 0, corners_.name(), 0,
                                static_cast<GLsizei>(corners_per_triangle() * sizeof(glm::vec3)));
    for (GLuint i = 0; i < corners_per_triangle(); ++i) add_attribute(VESTIGE_ATTRIBUTE_CORNERS + i, i);
    nowhere_.begin(1);
    check_gl(gl_, "preparing the candidates' shaders");
  }

  ~SkippingGeometryDetector() override {
    try {
      context_->make_current();
      gl_.DeleteVertexArrays(1, &vertex_array_);
    } catch (const Error&) {
      // The context is lost, together with everything in it.
    }
  }

  const char* name() const override { return "geometry"; }
  Method method() const override { return method_; }
  Skip skip() const override { return Skip::kOn; }
  GlInfo gl_info() const override { return context_->info(); }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {.frames_skipped = frame.out_of_reach > 0 ? 1U : 0U};
    candidates_.find(frame, stage_clock());
    DetectorWork work = candidates_.work();
    if (candidates_.touched().empty()) return work;
    enter(Stage::kUpload);
    fill_slots(frame);
    upload();
    captured_.capture(
        stage_clock(), draws_.size(), kBlockSegments * kMeshletTriangles,
        [this](std::size_t first, std::size_t count) { draw(first, count); },
        [&](const CapturedPair& pair) { work.pairs_captured += decide(frame, pair, row); });
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  /// Returns the vertices that the detector works with, which the CPU skins.
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  std::string head() const {
    return fmt::format(
        "#version 450 core\n{}#define METHOD {}\n#define BLOCK_SLOTS {}\n#define BLOCK_SEGMENTS {}\n"
        "#define MESHLET_TRIANGLES {}\n",
        shaders::kConstantsH, static_cast<int>(method_), kBlockSlots, kBlockSegments, kMeshletTriangles);
  }

  /// Three corners now, and the same three in the previous frame if the method uses it.
  std::size_t corners_per_triangle() const { return method_ == Method::kStatic ? 3 : 6; }

  void add_attribute(GLuint location, GLuint corner) const {
    gl_.EnableVertexArrayAttrib(vertex_array_, location);
    gl_.VertexArrayAttribBinding(vertex_array_, location, 0);
    gl_.VertexArrayAttribFormat(vertex_array_, location, 3, GL_FLOAT, GL_FALSE,
                                static_cast<GLuint>(corner * sizeof(glm::vec3)));
  }

  /// Distributes the candidates to as many blocks as they need. A meshlet whose segments do not fit into one block
  /// continues in the next.
  void fill_slots(const DetectorFrame& frame) {
    draws_.clear();
    gpu_corners_.clear();
    const std::span<const TouchedMeshlet> touched = candidates_.touched();
    for (std::size_t i = 0; i < touched.size(); ++i) {
      const std::span<const std::uint32_t> numbers = candidates_.segments(touched[i]);
      for (std::size_t offset = 0; offset < numbers.size();) {
        if (draws_.empty() || draws_.back().slots == kBlockSlots || draws_.back().segments == kBlockSegments) {
          draws_.push_back({.first_slot = draws_.empty() ? 0 : draws_.back().first_slot + draws_.back().slots});
          if (gpu_blocks_.size() < draws_.size()) gpu_blocks_.resize(draws_.size());
        }
        Draw& draw = draws_.back();
        Block& block = gpu_blocks_[draws_.size() - 1];
        const std::size_t count = std::min(numbers.size() - offset, kBlockSegments - draw.segments);
        block.slots[draw.slots++] = {static_cast<std::uint32_t>(draw.segments), static_cast<std::uint32_t>(count),
                                     static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(offset)};
        for (const std::uint32_t number : numbers.subspan(offset, count)) {
          const Segment& segment = frame.segments[number];
          block.segments[draw.segments++] = {glm::vec4(segment.start, bounding_radius_m(segment)),
                                             glm::vec4(segment.end, 0)};
        }
        add_corners(i);
        offset += count;
      }
    }
  }

  void add_corners(std::size_t touched) {
    const std::size_t first = gpu_corners_.size();
    gpu_corners_.resize(first + kMeshletTriangles * corners_per_triangle());
    glm::vec3* out = &gpu_corners_[first];
    for (std::size_t i = 0; i < kMeshletTriangles; ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) *out++ = candidates_.now(touched).at(corner, i);
      if (method_ == Method::kStatic) continue;
      for (std::size_t corner = 0; corner < 3; ++corner) *out++ = candidates_.before(touched).at(corner, i);
    }
  }

  /// Also sets what another detector of the context may have changed.
  void upload() {
    context_->make_current();
    gl_.UseProgram(program_.name());
    gl_.BindVertexArray(vertex_array_);
    nowhere_.bind();  // a draw without any framebuffer fails in a surfaceless context
    gl_.Enable(GL_RASTERIZER_DISCARD);
    corners_.upload(gpu_corners_.data(), gpu_corners_.size() * sizeof(glm::vec3), GL_STREAM_DRAW);
    blocks_.upload(nullptr, draws_.size() * sizeof(Block),
                   GL_STREAM_DRAW);  // a uniform block must be backed to its end
    blocks_.upload(gpu_blocks_.data(),
                   draws_.size() * sizeof(Block) - (kBlockSegments - draws_.back().segments) * sizeof(GpuSegment),
                   GL_STREAM_DRAW);
  }

  void draw(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) {
      gl_.BindBufferRange(GL_UNIFORM_BUFFER, VESTIGE_BINDING_CANDIDATES, blocks_.name(),
                          static_cast<GLintptr>(i * sizeof(Block)), static_cast<GLsizeiptr>(sizeof(Block)));
      gl_.DrawArrays(GL_POINTS, static_cast<GLint>(draws_[i].first_slot * kMeshletTriangles),
                     static_cast<GLsizei>(draws_[i].slots * kMeshletTriangles));
    }
  }

  /// Decides a captured pair. Returns 0 for the slots after the last meshlet's last triangle, otherwise 1.
  std::uint64_t decide(const DetectorFrame& frame, const CapturedPair& pair, ContactRow& row) {
    const std::size_t touched = pair.triangle / kMeshletTriangles;
    const std::size_t i = pair.triangle % kMeshletTriangles;
    const TouchedMeshlet& meshlet = candidates_.touched()[touched];
    const std::span<const std::uint32_t> triangles = meshlets_.triangles(meshlet.meshlet);
    if (i >= triangles.size()) return 0;
    const Corners now = candidates_.now(touched).corners(i);
    const Corners before = candidates_.before(touched).corners(i);
    const Segment& segment = frame.segments[candidates_.segments(meshlet)[pair.segment]];
    finder_.offer(frame, {before, now}, segment, triangles[i], row[segment.column]);
    return 1;
  }

  std::shared_ptr<GlContext> context_;
  const GlFunctions& gl_;
  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  Meshlets meshlets_;
  CandidatePatches candidates_;
  GlBuffer corners_;
  GlBuffer blocks_;
  CapturedPairs captured_;
  CollisionTexture nowhere_;
  GlProgram program_;
  GLuint vertex_array_ = 0;
  std::vector<Draw> draws_;
  std::vector<Block> gpu_blocks_;       ///< one for each draw
  std::vector<glm::vec3> gpu_corners_;  ///< for the triangles of each slot
};

}  // namespace

std::unique_ptr<Detector> make_skipping_geometry_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                          const ActuatorMap& map, const DetectorOptions& options) {
  return std::make_unique<SkippingGeometryDetector>(std::move(context), avatar, map, options);
}

}  // namespace vestige
