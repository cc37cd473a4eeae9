#include "detector/detectors/gpu_culler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/detectors/candidate_prover.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// Groups that every driver allows in a dispatch (GL_MAX_COMPUTE_WORK_GROUP_COUNT).
constexpr std::size_t kMostMeshlets = 65535;
/// A group tests all of them. So few that its loops stay far below the 65 535 rounds that llvmpipe runs.
constexpr std::size_t kMostSegments = 4096;
constexpr std::size_t kMostSlots = 8192;
/// In terms of the skin's reach. Longer ways are worth to be cut (WayCutter), which the CPU does.
constexpr double kLongestWay = 4;
constexpr std::size_t kGroupThreads = 64;
constexpr std::size_t kCorners = 3 * kMeshletTriangles;
constexpr std::size_t kCornerTexels = sizeof(MeshletCorners) / sizeof(glm::vec4);

// The margins. Let u = 2^-24, and R the reach of the palettes (skin_reach_m), the largest along any axis.
// Boxes: MeshletBounds::pad_m covers the errors of the shader's box as it does those of the CPU's. They differ only
// where denormals are flushed.
// Corners: shader and CPU each err by at most 12 u R (1 + e), where 1 + e is the largest sum of a vertex's weights
// (meshlet_bounds.cpp), and e < 1/2 where there are bounds. Together that is 36 u R. The rest of 48 u R covers the
// rounding of what shaders compute with it. With `carried`, the displacement of a start errs by 2 corners, and is
// compared with one.
// Flushed denormals: to flush an operand or a result below 2^-126 errs by less than 2^-126 times the other factors.
// These are at most 2^26, or 2^26 times a weight. It happens fewer than 1000 times. kLeast is larger than all of this.
constexpr double kCornerError = 0x1.8p-19;
constexpr double kCarriedErrors = 3.5;
constexpr double kLargest = 0x1p26;
constexpr float kLeast_m = 0x1p-86F;

struct RestBoxes {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// std430 layouts of shaders/cull.comp and candidates.glsl.
struct GpuMeshlet {
  RestBoxes boxes;
  std::array<std::uint32_t, kCorners> vertices;
};
static_assert(sizeof(RestBox) == 32);

std::size_t sets_of(Method method) {
  return method == Method::kStatic ? 1 : 2;
}

std::size_t most_places(const GlFunctions& gl, const Meshlets& meshlets, Method method) {
  const auto texels = static_cast<std::size_t>(gl_limit(gl, GL_MAX_TEXTURE_BUFFER_SIZE));
  return std::clamp<std::size_t>(meshlets.size(), 1, texels / (kCornerTexels * sets_of(method)));
}

/// The influences that the shader's Vertex has room for.
std::size_t gpu_influences(const Avatar& avatar) {
  return avatar.influence_count <= 4 ? 4 : 8;
}

std::vector<GpuMeshlet> gpu_meshlets(const Avatar& avatar, const Meshlets& meshlets) {
  std::vector<GpuMeshlet> out(meshlets.size());
  std::uint32_t first = 0;
  for (std::size_t m = 0; m < out.size(); ++m) {
    out[m].boxes = {first, static_cast<std::uint32_t>(meshlets.rest_boxes(0, m).size())};
    first += out[m].boxes.count;
    const std::span<const std::uint32_t> triangles = meshlets.triangles(m);
    for (std::size_t i = 0; i < kCorners; ++i) {
      const std::size_t triangle = i % kMeshletTriangles < triangles.size() ? i % kMeshletTriangles : 0;
      out[m].vertices[i] = avatar.triangles[triangles[triangle]][static_cast<int>(i / kMeshletTriangles)];
    }
  }
  return out;
}

std::vector<RestBox> all_rest_boxes(const Meshlets& meshlets) {
  std::vector<RestBox> out;
  for (std::size_t m = 0; m < meshlets.size(); ++m) {
    const std::span<const RestBox> boxes = meshlets.rest_boxes(0, m);
    out.insert(out.end(), boxes.begin(), boxes.end());
  }
  return out;
}

/// The shader's vertices, word by word: the bind position, the palette entries, and the weights.
std::vector<std::uint32_t> gpu_vertices(const Avatar& avatar) {
  const std::size_t influences = gpu_influences(avatar);
  std::vector<std::uint32_t> out;
  out.reserve(avatar.position_bind.size() * (4 + 2 * influences));
  for (std::size_t vertex = 0; vertex < avatar.position_bind.size(); ++vertex) {
    const auto add = [&](float number) { out.push_back(std::bit_cast<std::uint32_t>(number)); };
    for (int axis = 0; axis < 3; ++axis) add(avatar.position_bind[vertex][axis]);
    add(0);
    const Influences& of_vertex = avatar.influences[vertex];
    for (std::size_t k = 0; k < influences; ++k) out.push_back(of_vertex.palette[k]);
    for (std::size_t k = 0; k < influences; ++k) add(of_vertex.weight[k]);
  }
  return out;
}

std::string after_proofs(std::string_view stage) {
  return std::string(shaders::kCandidatesGlsl) + std::string(stage);
}

template <typename T>
void upload_all(GlBuffer& buffer, const std::vector<T>& data, GLenum usage) {
  buffer.upload(data.data(), data.size() * sizeof(T), usage);
}

}  // namespace

struct GpuCuller::Counts {
  std::array<GLuint, 3> groups = {0, 1, 1};  ///< the command of an indirect dispatch
  std::uint32_t slots = 0;
  std::uint32_t places = 0;
  std::uint32_t pairs = 0;
  std::uint32_t tested = 0;
  std::uint32_t corners_skinned = 0;
};

struct GpuCuller::Slot {
  std::uint32_t meshlet;
  std::uint32_t count;
  std::uint32_t place;
  std::array<std::uint32_t, kSlotSegments> segments;
};

GpuCuller::Programs::Programs(const GlFunctions& gl, const std::string& head)
    : cull(gl, head, {{GL_COMPUTE_SHADER, "cull.comp", after_proofs(shaders::kCullComp)}}),
      prove(gl, head, {{GL_COMPUTE_SHADER, "candidates.comp", after_proofs(shaders::kCandidatesComp)}}) {}

GpuCuller::GpuCuller(const GlContext& context, const Avatar& avatar, const Meshlets& meshlets, Method method)
    : gl_(context.gl()),
      avatar_(avatar),
      meshlets_(meshlets),
      method_(method),
      wait_(context.info().software ? FenceWait::kAsleep : FenceWait::kActive),
      most_places_(most_places(gl_, meshlets, method)),
      bounds_(avatar, meshlets),
      bind_extent_m_(bind_extent_m(avatar)),
      meshlet_buffer_(gl_),
      rest_boxes_(gl_),
      vertices_(gl_),
      palette_(gl_),
      segments_(gl_),
      slots_(gl_),
      corners_(gl_),
      counts_(gl_),
      counted_(gl_, sizeof(Counts)),
      found_(gl_, kMostSlots * sizeof(Slot)),
      words_(gl_, kMostSlots * kSlotLanes * sizeof(std::uint32_t)),
      timer_(gl_) {
  upload_all(meshlet_buffer_, gpu_meshlets(avatar, meshlets), GL_STATIC_DRAW);
  upload_all(rest_boxes_, all_rest_boxes(meshlets), GL_STATIC_DRAW);
  upload_all(vertices_, gpu_vertices(avatar), GL_STATIC_DRAW);
  slots_.upload(nullptr, kMostSlots * sizeof(Slot), GL_STREAM_COPY);
  corners_.upload(nullptr, most_places_ * sets_of(method) * sizeof(MeshletCorners), GL_STREAM_COPY);
  gl_.CreateTextures(GL_TEXTURE_BUFFER, 1, &corner_texture_);
  gl_.TextureBuffer(corner_texture_, GL_RGBA32F, corners_.name());
  check_gl(gl_, "uploading the avatar");
}

GpuCuller::~GpuCuller() {
  if (fence_ != nullptr) gl_.DeleteSync(fence_);
  gl_.DeleteTextures(1, &corner_texture_);
}

const GpuCuller::Programs& GpuCuller::programs(bool has_spheres) {
  std::optional<Programs>& programs = programs_[has_spheres ? 1 : 0];
  if (programs) return *programs;
  const std::string head = fmt::format(
      "#version 450 core\n{}#define METHOD {}\n#define SPHERES {}\n#define CULLED_ON_GPU 1\n#define LANES {}u\n"
      "#define SLOT_SEGMENTS {}u\n#define GROUP_THREADS {}u\n#define MOST_SLOTS {}u\n#define MOST_PLACES {}u\n"
      "#define SETS {}u\n#define CORNERS {}u\n#define INFLUENCES {}\n",
      shaders::kConstantsH, static_cast<int>(method_), has_spheres ? 1 : 0, kSlotLanes, kSlotSegments, kGroupThreads,
      kMostSlots, most_places_, sets_of(method_), kCorners, gpu_influences(avatar_));
  programs.emplace(gl_, head);
  return *programs;
}

bool GpuCuller::submit(const DetectorFrame& frame, StageClock* clock) {
  if (meshlets_.size() == 0 || meshlets_.size() > kMostMeshlets || frame.segments.size() > kMostSegments) return false;
  enter_stage(clock, Stage::kUpload);
  if (!set_margins(frame)) return false;
  segment_count_ = frame.segments.size();
  upload_frame(frame);
  const Programs& chosen = programs(std::ranges::any_of(frame.segments, &Segment::is_sphere));
  timer_.time(clock, [&] { start(chosen); });
  fence_ = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  return true;
}

/// Returns false if nothing is known of the errors, or if a way is too long.
bool GpuCuller::set_margins(const DetectorFrame& frame) {
  if (std::max({bind_extent_m_.x, bind_extent_m_.y, bind_extent_m_.z}) > kLargest) return false;
  bounds_.begin(frame, method_);
  if (!std::isfinite(bounds_.pad_m())) return false;
  double reach_m = 0;
  for (const std::vector<SkinMatrix>* palette : {&frame.palette, &frame.palette_before}) {
    const std::optional<glm::dvec3> reach = palette_reach_m(*palette, bind_extent_m_, kLargest);
    if (!reach) return false;
    reach_m = std::max({reach_m, reach->x, reach->y, reach->z});
    if (method_ == Method::kStatic) break;
  }
  for (const Segment& segment : frame.segments) {
    const glm::vec3 way = glm::abs(segment.end - segment.start);
    if (!(static_cast<double>(std::max({way.x, way.y, way.z})) <= kLongestWay * reach_m)) return false;
  }
  const double errors = method_ == Method::kCarried ? kCarriedErrors : 1;
  box_margin_m_ = bounds_.pad_m() + kLeast_m;
  corner_error_m_ = static_cast<float>(reach_m * kCornerError * errors) + kLeast_m;
  return true;
}

void GpuCuller::upload_frame(const DetectorFrame& frame) {
  gpu_palette_ = frame.palette;
  if (method_ != Method::kStatic)
    gpu_palette_.insert(gpu_palette_.end(), frame.palette_before.begin(), frame.palette_before.end());
  upload_all(palette_, gpu_palette_, GL_STREAM_DRAW);
  gpu_segments_.clear();
  for (const Segment& segment : frame.segments) {
    gpu_segments_.emplace_back(segment.start, bounding_radius_m(segment));
    gpu_segments_.emplace_back(segment.end, 0);
  }
  upload_all(segments_, gpu_segments_, GL_STREAM_DRAW);
  const Counts zeros;
  counts_.upload(&zeros, sizeof(zeros), GL_STREAM_DRAW);
}

void GpuCuller::start(const Programs& programs) {
  const auto bind = [&](GLuint binding, GLuint buffer) {
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
  };
  const GLuint cull = programs.cull.name();
  bind(VESTIGE_BINDING_PALETTE, palette_.name());
  bind(VESTIGE_BINDING_SEGMENTS, segments_.name());
  bind(VESTIGE_BINDING_CULLED_CORNERS, corners_.name());
  bind(VESTIGE_BINDING_CANDIDATES, slots_.name());
  bind(VESTIGE_BINDING_COUNTS, counts_.name());
  bind(VESTIGE_BINDING_MESHLETS, meshlet_buffer_.name());
  bind(VESTIGE_BINDING_REST_BOXES, rest_boxes_.name());
  bind(VESTIGE_BINDING_VERTICES, vertices_.name());
  gl_.ProgramUniform1ui(cull, VESTIGE_UNIFORM_SEGMENT_COUNT, static_cast<GLuint>(segment_count_));
  gl_.ProgramUniform1ui(cull, VESTIGE_UNIFORM_PALETTE_SIZE, static_cast<GLuint>(avatar_.palette.size()));
  gl_.ProgramUniform1f(cull, VESTIGE_UNIFORM_BOX_MARGIN, box_margin_m_);
  gl_.UseProgram(cull);
  gl_.DispatchCompute(static_cast<GLuint>(meshlets_.size()), 1, 1);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);

  bind(VESTIGE_BINDING_FOUND, found_.name());
  bind(VESTIGE_BINDING_CAPTURED, words_.name());
  gl_.BindTextureUnit(VESTIGE_TEXTURE_CORNERS, corner_texture_);
  gl_.ProgramUniform1f(programs.prove.name(), VESTIGE_UNIFORM_CORNER_ERROR, corner_error_m_);
  gl_.UseProgram(programs.prove.name());
  gl_.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, counts_.name());
  gl_.DispatchComputeIndirect(offsetof(Counts, groups));
  gl_.CopyNamedBufferSubData(counts_.name(), counted_.name(), 0, 0, sizeof(Counts));
  gl_.MemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

std::optional<std::span<const CulledPair>> GpuCuller::collect(StageClock* clock) {
  enter_stage(clock, Stage::kReadBack);
  await_fence(gl_, std::exchange(fence_, nullptr), wait_);
  check_gl(gl_, "culling and proving");
  Counts counts;
  std::memcpy(&counts, counted_.data(), sizeof(counts));
  if (counts.tested != meshlets_.size() * segment_count_) throw unfinished_shader();
  const bool has_room = counts.slots <= kMostSlots && counts.places <= most_places_;
  if (has_room) {
    if (counts.corners_skinned != counts.places * sets_of(method_) * kCorners) throw unfinished_shader();
    read_pairs(counts);
  }
  clear_words(std::min<std::size_t>(counts.slots, kMostSlots));
  if (!has_room) return {};
  return pairs_;
}

/// Slots come in any order.
void GpuCuller::read_pairs(const Counts& counts) {
  const auto* found = reinterpret_cast<const Slot*>(found_.data());
  const auto* words = reinterpret_cast<const std::array<std::uint32_t, kSlotLanes>*>(words_.data());
  pairs_.clear();
  for (std::size_t i = 0; i < counts.slots; ++i) {
    const Slot& slot = found[i];
    if (slot.count == 0 || slot.count > kSlotSegments || slot.meshlet >= meshlets_.size()) throw unfinished_shader();
    std::array<std::uint32_t, kSlotSegments> bits;
    unpack_words(words[i], slot.count, bits.data());
    const std::uint32_t all = bits_of(meshlets_.triangles(slot.meshlet).size());
    for (std::size_t k = 0; k < slot.count; ++k) {
      if (slot.segments[k] >= segment_count_) throw unfinished_shader();
      pairs_.push_back({slot.meshlet, slot.segments[k], bits[k] & all});
    }
  }
  if (pairs_.size() != counts.pairs) throw unfinished_shader();
  std::ranges::sort(pairs_, {}, [](const CulledPair& pair) { return std::pair(pair.meshlet, pair.segment); });
}

/// So that a lane that does not write its word in the next frame is noticed.
void GpuCuller::clear_words(std::size_t slots) {
  std::memset(words_.data(), 0, slots * kSlotLanes * sizeof(std::uint32_t));
}

}  // namespace vestige
