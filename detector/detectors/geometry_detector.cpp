#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "detector/broad/skin_motion.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/detectors/shader_proof_detector.hpp"
#include "detector/gl/captured_pairs.hpp"
#include "detector/gl/collision_texture.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/gl/skinned_mesh.hpp"
#include "detector/skinning.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

static_assert(static_cast<int>(Method::kStatic) == VESTIGE_METHOD_STATIC);
static_assert(static_cast<int>(Method::kCarried) == VESTIGE_METHOD_CARRIED);
static_assert(static_cast<int>(Method::kCcd) == VESTIGE_METHOD_CCD);

/// std140 layout of the shader's GpuSegment; the other fourth components are padding.
struct GpuSegment {
  glm::vec4 low;
  glm::vec4 high;
  glm::vec4 start;  ///< w: bounding_radius_m
  glm::vec4 end;
};
static_assert(sizeof(GpuSegment) == 64);

/// The size that every driver allows for a uniform block (GL_MAX_UNIFORM_BLOCK_SIZE).
constexpr std::size_t kUniformBlockBytes = 16384;
constexpr std::size_t kBlockSegments = kUniformBlockBytes / sizeof(GpuSegment);

/// The shader's `least_radius`: a bound for the error of a skinned vertex's coordinate if denormals are flushed to
/// zero. The vertex is a sum of 8 products w M x, with intermediate results. To flush an operand or a result below
/// 2^-126 errs by less than 2^-126 times the other factors. Each time that is less than 2^-126 (1 + H + X). H is the
/// largest |M_0 x| + ... + |M_3|, with |x| taken as at least 1. X is the largest such |x|. Weights are at most about 1.
/// It happens fewer than 100 times, and gradual underflow on the CPU errs by less. The function returns 1024 times the
/// bound for one.
float least_radius_m(std::span<const SkinMatrix> palette, const glm::dvec3& extent_m) {
  const glm::dvec3 extent = glm::max(extent_m, glm::dvec3(1));
  double largest = 0;
  for (const SkinMatrix& matrix : palette) {
    const glm::dvec3 reach = skin_reach_m(matrix, extent);
    largest = std::max(largest, reach.x + reach.y + reach.z);
  }
  return static_cast<float>(std::ldexp(1 + largest + extent.x + extent.y + extent.z, -116));
}

/// Tests every segment against every triangle.
class GeometryDetector final : public Detector {
 public:
  GeometryDetector(std::shared_ptr<GlContext> context, const Avatar& avatar, const ActuatorMap& map,
                   const DetectorOptions& options)
      : context_(std::move(context)),
        gl_(current_gl(*context_)),
        avatar_(avatar),
        method_(options.method),
        finder_(avatar, map, options),
        bind_extent_m_(bind_extent_m(avatar)),
        palette_(gl_),
        segments_(gl_),
        mesh_(gl_, avatar),
        captured_(gl_),
        nowhere_(gl_, PlaneSet()),
        program_(gl_, head(),
                 {{GL_VERTEX_SHADER, "geometry.vert", shaders::kGeometryVert},
                  {GL_GEOMETRY_SHADER, "geometry.geom", shaders::kGeometryGeom}}) {
    nowhere_.begin(1);
    check_gl(gl_, "uploading the avatar");
  }

  ~GeometryDetector() override {
    try {
      context_->make_current();
    } catch (const Error&) {
      // The context is lost, together with everything in it.
    }
  }

  const char* name() const override { return "geometry"; }
  Method method() const override { return method_; }
  GlInfo gl_info() const override { return context_->info(); }
  bool skins_in_shader() const override { return true; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {};
    enter(Stage::kUpload);
    begin(program_);
    upload_palette(frame, program_);
    upload_segments(frame);
    std::uint64_t pairs_captured = 0;
    captured_.capture(
        stage_clock(), avatar_.triangles.size(), frame.segments.size(),
        [&](std::size_t first, std::size_t count) { draw(frame.segments.size(), first, count); },
        [&](const CapturedPair& pair) {
          const Segment& segment = frame.segments[pair.segment];
          const MovingCorners corners = skin_corners(avatar_, frame, method_, pair.triangle);
          finder_.offer(frame, corners, segment, pair.triangle, row[segment.column]);
          ++pairs_captured;
        });
    DetectorWork work = {.pairs_tested = frame.segments.size() * avatar_.triangles.size(),
                         .triangles_tested = avatar_.triangles.size(),
                         .pairs_captured = pairs_captured};
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    if (!skinning_program_) {
      context_->make_current();
      skinning_program_.emplace(
          gl_, head(),
          std::initializer_list<GlProgram::Stage>{{GL_VERTEX_SHADER, "geometry.vert", shaders::kGeometryVert}},
          "Skinned.position");
    }
    begin(*skinning_program_);
    upload_palette(frame, *skinning_program_);
    mesh_.capture(out);
    check_gl(gl_, "capturing skinned vertices");
  }

 private:
  /// Sets what another detector of the context may have changed.
  void begin(const GlProgram& program) {
    context_->make_current();
    gl_.UseProgram(program.name());
    mesh_.bind();
    nowhere_.bind();  // a draw without any framebuffer fails in a surfaceless context
    gl_.Enable(GL_RASTERIZER_DISCARD);
  }

  /// The capacity of the shaders' palette, in entries.
  std::size_t palette_entries() const {
    return avatar_.palette.size() * (method_ == Method::kStatic ? std::size_t{1} : std::size_t{2});
  }
  bool palette_in_uniform_block() const { return palette_entries() * sizeof(SkinMatrix) <= kUniformBlockBytes; }

  std::string head() const {
    return fmt::format(
        "#version 450 core\n{}#define METHOD {}\n#define BLOCK_SEGMENTS {}\n#define INFLUENCES {}\n"
        "#define PALETTE_ENTRIES {}\n",
        shaders::kConstantsH, static_cast<int>(method_), kBlockSegments, avatar_.influence_count,
        palette_in_uniform_block() ? palette_entries() : 0);
  }

  /// Uploads this frame's palette, followed by that of the previous frame if the method uses it.
  void upload_palette(const DetectorFrame& frame, const GlProgram& program) {
    float least_radius = least_radius_m(frame.palette, bind_extent_m_);
    gpu_palette_ = frame.palette;
    if (method_ != Method::kStatic) {
      gpu_palette_.insert(gpu_palette_.end(), frame.palette_before.begin(), frame.palette_before.end());
      least_radius = std::max(least_radius, least_radius_m(frame.palette_before, bind_extent_m_));
    }
    palette_.upload(gpu_palette_.data(), gpu_palette_.size() * sizeof(SkinMatrix), GL_STREAM_DRAW);
    gl_.BindBufferBase(palette_in_uniform_block() ? GL_UNIFORM_BUFFER : GL_SHADER_STORAGE_BUFFER,
                       VESTIGE_BINDING_PALETTE, palette_.name());
    gl_.ProgramUniform1ui(program.name(), VESTIGE_UNIFORM_PALETTE_SIZE, static_cast<GLuint>(frame.palette.size()));
    gl_.ProgramUniform1f(program.name(), VESTIGE_UNIFORM_LEAST_RADIUS, least_radius);
  }

  void upload_segments(const DetectorFrame& frame) {
    gpu_segments_.clear();
    gpu_segments_.reserve(frame.segments.size());
    for (const Segment& segment : frame.segments) {
      const SegmentBox box = box_of(segment);
      gpu_segments_.push_back({glm::vec4(box.low, 0), glm::vec4(box.high, 0),
                               glm::vec4(segment.start, bounding_radius_m(segment)), glm::vec4(segment.end, 0)});
    }
    // Allocate whole blocks, because a uniform block must be backed to its end.
    const std::size_t blocks = (gpu_segments_.size() + kBlockSegments - 1) / kBlockSegments;
    segments_.upload(nullptr, blocks * kUniformBlockBytes, GL_STREAM_DRAW);
    segments_.upload(gpu_segments_.data(), gpu_segments_.size() * sizeof(GpuSegment), GL_STREAM_DRAW);
  }

  /// Draws `triangles` triangles from `first_triangle` on against all segments.
  void draw(std::size_t segments, std::size_t first_triangle, std::size_t triangles) {
    gl_.ProgramUniform1i(program_.name(), VESTIGE_UNIFORM_FIRST_TRIANGLE, static_cast<GLint>(first_triangle));
    for (std::size_t first = 0; first < segments; first += kBlockSegments) {
      gl_.BindBufferRange(GL_UNIFORM_BUFFER, VESTIGE_BINDING_SEGMENTS, segments_.name(),
                          static_cast<GLintptr>(first * sizeof(GpuSegment)),
                          static_cast<GLsizeiptr>(kUniformBlockBytes));
      gl_.ProgramUniform1i(program_.name(), VESTIGE_UNIFORM_SEGMENT_COUNT,
                           static_cast<GLint>(std::min(segments - first, kBlockSegments)));
      gl_.ProgramUniform1i(program_.name(), VESTIGE_UNIFORM_FIRST_SEGMENT, static_cast<GLint>(first));
      mesh_.draw_range(first_triangle, triangles);
    }
  }

  std::shared_ptr<GlContext> context_;
  const GlFunctions& gl_;
  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  glm::dvec3 bind_extent_m_;
  GlBuffer palette_;
  GlBuffer segments_;
  SkinnedMesh mesh_;
  CapturedPairs captured_;
  CollisionTexture nowhere_;
  GlProgram program_;
  std::optional<GlProgram> skinning_program_;
  std::vector<SkinMatrix> gpu_palette_;
  std::vector<GpuSegment> gpu_segments_;
};

}  // namespace

std::unique_ptr<Detector> make_geometry_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                 const ActuatorMap& map, const DetectorOptions& options) {
  require_proofs("geometry", context->info());
  if (options.skip == Skip::kOn)
    return make_shader_proof_detector(std::move(context), ProofStage::kGeometry, avatar, map, options);
  return std::make_unique<GeometryDetector>(std::move(context), avatar, map, options);
}

void require_proofs(std::string_view detector, const GlInfo& gl) {
  const std::string cause = breaks_proofs(gl.arithmetic, gl.probe_refusal);
  if (!cause.empty())
    throw Error(fmt::format("--detector {}", detector),
                fmt::format("is not known to be exact on {} ({}): {}", gl.context, gl.renderer, cause),
                "use --detector cpu, which finds the same contacts, or another --context or --device");
}

}  // namespace vestige
