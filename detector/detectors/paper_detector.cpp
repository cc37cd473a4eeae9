#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/collision_texture.hpp"
#include "detector/gl/draw_timer.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/gl/skinned_mesh.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// std430 layout of the shader's GpuSegment.
struct GpuSegment {
  glm::vec3 start;
  std::uint32_t column;
  glm::vec3 end;
  std::uint32_t unused;
};
static_assert(sizeof(GpuSegment) == 32);

/// The CPU computes the pressure from the speed. Many drivers have no ninth texture to draw into.
DetectorOptions with_sources(DetectorOptions options) {
  if (options.planes.has(Plane::kPressure)) options.planes = options.planes | Plane::kSpeed;
  return options;
}

class PaperDetector final : public Detector {
 public:
  PaperDetector(std::shared_ptr<GlContext> context, const Avatar& avatar, const ActuatorMap& map,
                const DetectorOptions& options)
      : context_(std::move(context)),
        gl_(current_gl(*context_)),
        avatar_(avatar),
        options_(with_sources(options)),
        small_shares_(options.as_on_gpu || !context_->info().software),
        map_per_triangle_(map.triangle_count != 0),
        palette_(gl_),
        segments_(gl_),
        mesh_(gl_, avatar),
        texture_(gl_, options_.planes),
        timer_(gl_) {
    std::size_t components = 4;  // gl_Position
    for (const GlPlane& plane : kGlPlanes)
      if (options_.planes.has(plane.plane)) components += plane.geometry_components;
    const auto total = static_cast<std::size_t>(gl_limit(gl_, GL_MAX_GEOMETRY_TOTAL_OUTPUT_COMPONENTS));
    const auto most = static_cast<std::size_t>(gl_limit(gl_, GL_MAX_GEOMETRY_OUTPUT_VERTICES));
    largest_share_ = std::bit_floor(std::min(total / components, most));

    upload_map(map);
    check_gl(gl_, "uploading the avatar");
  }

  ~PaperDetector() override {
    try {
      context_->make_current();
      gl_.DeleteTextures(1, &map_texture_);
    } catch (const Error&) {
      // The context is lost, together with everything in it.
    }
  }

  const char* name() const override { return "paper"; }
  GlInfo gl_info() const override { return context_->info(); }
  bool skins_in_shader() const override { return true; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    enter(Stage::kUpload);
    context_->make_current();
    upload_frame(frame);
    timer_.time(stage_clock(), [&] { draw(frame); });
    enter(Stage::kReadBack);
    read_back(row);
    check_gl(gl_, "detecting contacts");
    return {frame.segments.size() * avatar_.triangles.size(), avatar_.triangles.size()};
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    context_->make_current();
    upload_frame(frame);
    if (!skinning_program_) {
      skinning_program_.emplace(
          gl_, head({}), std::initializer_list<GlProgram::Stage>{{GL_VERTEX_SHADER, "paper.vert", shaders::kPaperVert}},
          "Skinned.position");
    }
    texture_.begin(1);
    gl_.UseProgram(skinning_program_->name());
    gl_.Enable(GL_RASTERIZER_DISCARD);
    mesh_.capture(out);
    gl_.Disable(GL_RASTERIZER_DISCARD);
    check_gl(gl_, "capturing skinned vertices");
  }

 private:
  void upload_map(const ActuatorMap& map) {
    const auto side = static_cast<std::uint32_t>(gl_limit(gl_, GL_MAX_TEXTURE_SIZE));
    if (map.width > side || map.height > side)
      throw Error(
          "--map",
          fmt::format("has {} x {} texels, but a side has at most {} with this driver", map.width, map.height, side),
          map.triangle_count == 0 ? "scale the map down, without smoothing" : "choose another detector");
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &map_texture_);
    gl_.TextureStorage2D(map_texture_, 1, GL_R16UI, static_cast<GLsizei>(map.width), static_cast<GLsizei>(map.height));
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TextureSubImage2D(map_texture_, 0, 0, 0, static_cast<GLsizei>(map.width), static_cast<GLsizei>(map.height),
                          GL_RED_INTEGER, GL_UNSIGNED_SHORT, map.actuator.data());
    gl_.TextureParameteri(map_texture_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.TextureParameteri(map_texture_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_.TextureParameteri(map_texture_, GL_TEXTURE_WRAP_S, GL_REPEAT);
    gl_.TextureParameteri(map_texture_, GL_TEXTURE_WRAP_T, GL_REPEAT);
  }

  /// Uploads the palette and the segments of this frame, and sets what another detector of the context may have
  /// changed.
  void upload_frame(const DetectorFrame& frame) {
    palette_.upload(frame.palette.data(), frame.palette.size() * sizeof(SkinMatrix), GL_STREAM_DRAW);
    gpu_segments_.clear();
    for (const Segment& segment : frame.segments)
      gpu_segments_.push_back({segment.start, segment.column, segment.end, 0});
    segments_.upload(gpu_segments_.data(), gpu_segments_.size() * sizeof(GpuSegment), GL_STREAM_DRAW);
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_PALETTE, palette_.name());
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_SEGMENTS, segments_.name());
    gl_.BindTextureUnit(VESTIGE_TEXTURE_ACTUATOR_MAP, map_texture_);
    gl_.Disable(GL_RASTERIZER_DISCARD);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  }

  void draw(const DetectorFrame& frame) {
    texture_.begin(frame.columns);
    const auto [program, share] = program_for(frame.segments.size());
    gl_.UseProgram(program);
    gl_.ProgramUniform1i(program, VESTIGE_UNIFORM_SEGMENT_COUNT, static_cast<GLint>(frame.segments.size()));
    gl_.ProgramUniform1i(program, VESTIGE_UNIFORM_TEXTURE_COLUMNS, texture_.width());
    gl_.ProgramUniform1i(program, VESTIGE_UNIFORM_TEXTURE_ROWS, texture_.height());
    gl_.ProgramUniform1f(program, VESTIGE_UNIFORM_FRAMES_PER_S,
                         frame.duration_s > 0 ? static_cast<float>(1 / frame.duration_s) : 0.0F);
    const std::size_t drawn = share.segments * share.invocations;  // in one instance
    mesh_.bind();
    mesh_.draw(static_cast<GLsizei>((frame.segments.size() + drawn - 1) / drawn));
  }

  /// How many segments an invocation of the geometry shader tests, and how many invocations a triangle gets in one
  /// draw. What remains is drawn in further instances.
  struct Share {
    std::size_t segments = 1;
    std::size_t invocations = 1;
  };

  /// The shader may emit a point for each segment, so an invocation never tests more segments than it may emit points:
  /// no contact can be dropped. Powers of two keep the number of programs small.
  ///
  /// A GPU reserves room for all points that an invocation may emit, so a few large shares leave most of it idle.
  /// Measured on an NVIDIA H100, 4998 triangles against 100 colliders, microseconds a draw: 128 segments in one
  /// invocation, 1412; 8 segments, in 13 instances, 283; 4 segments in 32 invocations, 186. On llvmpipe small shares
  /// cost 2 to 6 times as much as large ones. All of this is with one plane; more make points larger.
  Share share_for(std::size_t segments) const {
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(segments, 1));
    if (!small_shares_) return {std::min(size, largest_share_), 1};
    constexpr std::size_t kInvocations = 32;  // what every driver allows
    const std::size_t invocations = std::clamp<std::size_t>(size / 2, 1, kInvocations);
    return {std::min({size / invocations, std::size_t{4}, largest_share_}), invocations};
  }

  /// Returns the program for this number of segments, and their share. A driver may link less than its limits allow: if
  /// it refuses a program of small shares, tries large ones, and then half as large. Every later call does so too.
  std::pair<GLuint, Share> program_for(std::size_t segments) {
    for (;;) {
      const Share share = share_for(segments);
      try {
        return {program_of(share).name(), share};
      } catch (const Error&) {
        if (std::exchange(small_shares_, false)) continue;
        if (share.segments == 1) throw;
        largest_share_ = share.segments / 2;
      }
    }
  }

  const GlProgram& program_of(const Share& share) {
    auto& program = programs_[{share.segments, share.invocations}];
    if (!program) {
      program.emplace(gl_, head(share),
                      std::initializer_list<GlProgram::Stage>{{GL_VERTEX_SHADER, "paper.vert", shaders::kPaperVert},
                                                              {GL_GEOMETRY_SHADER, "paper.geom", shaders::kPaperGeom},
                                                              {GL_FRAGMENT_SHADER, "paper.frag", shaders::kPaperFrag}});
    }
    return *program;
  }

  std::string head(const Share& share) const {
    return fmt::format(
        "#version 450 core\n{}#define PLANES {}\n#define SHARE_SEGMENTS {}\n#define INVOCATIONS {}\n"
        "#define INFLUENCES {}\n#define MAPPED_ONLY {}\n#define MAP_PER_TRIANGLE {}\n",
        shaders::kConstantsH, options_.planes.bits(), share.segments, share.invocations, avatar_.influence_count,
        options_.surface == Surface::kMapped ? 1 : 0, map_per_triangle_ ? 1 : 0);
  }

  void read_back(ContactRow& row) {
    texture_.read();
    for (std::size_t i = 0; i < kGlPlanes.size(); ++i) {
      if (!options_.planes.has(kGlPlanes[i].plane)) continue;
      const std::span<const std::uint32_t> texels = texture_.texels(i);
      for (std::size_t column = 0; column < row.size(); ++column) {
        // The actuator plane comes first and shows which texels have a contact.
        if (i != VESTIGE_PLANE_ACTUATOR && !row[column].hit()) continue;
        store(kGlPlanes[i].plane, &texels[column * kGlPlanes[i].components], row[column]);
      }
    }
  }

  static void store(Plane plane, const std::uint32_t* texel, Contact& contact) {
    const auto value = [&](std::size_t component) { return std::bit_cast<float>(texel[component]); };
    switch (plane) {
      case Plane::kActuator:
        if (!std::isfinite(value(0))) return;
        contact.triangle = kUnreadTriangle;
        contact.actuator = static_cast<std::uint16_t>(value(0));
        return;
      case Plane::kTime:
        contact.t = value(0);
        return;
      case Plane::kTriangle:
        contact.triangle = texel[0];
        return;
      case Plane::kBarycentric:
        contact.barycentric = {value(0), value(1)};
        return;
      case Plane::kTextureCoordinate:
        contact.texture_coordinate = {value(0), value(1)};
        return;
      case Plane::kPosition:
        contact.position = {value(0), value(1), value(2)};
        return;
      case Plane::kSpeed:
        contact.speed_m_per_s = value(0);
        return;
      case Plane::kSide:
        contact.side = static_cast<std::int8_t>(value(0));
        return;
      case Plane::kPressure:  // no texture carries these
      case Plane::kDepth:
        return;
    }
  }

  /// A contact whose triangle plane was not asked for still counts as one.
  static constexpr std::uint32_t kUnreadTriangle = 0;

  std::shared_ptr<GlContext> context_;
  const GlFunctions& gl_;
  const Avatar& avatar_;
  DetectorOptions options_;
  bool small_shares_;
  bool map_per_triangle_;
  std::size_t largest_share_ = 1;  ///< segments that an invocation may test
  GlBuffer palette_;
  GlBuffer segments_;
  SkinnedMesh mesh_;
  GLuint map_texture_ = 0;
  CollisionTexture texture_;
  DrawTimer timer_;
  /// By the segments and the invocations of a share.
  std::map<std::pair<std::size_t, std::size_t>, std::optional<GlProgram>> programs_;
  std::optional<GlProgram> skinning_program_;
  std::vector<GpuSegment> gpu_segments_;
};

}  // namespace

std::unique_ptr<Detector> make_paper_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                              const ActuatorMap& map, const DetectorOptions& options) {
  return std::make_unique<PaperDetector>(std::move(context), avatar, map, options);
}

}  // namespace vestige
