#include "detector/proofs/gpu_culler.hpp"

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
#include "detector/proofs/candidate_words.hpp"
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
constexpr std::size_t kCorners = 3 * kMeshletTriangles;

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

std::size_t most_places(const GlFunctions& gl, const Meshlets& meshlets, Method method) {
  return std::min(meshlets.size(), most_meshlets_in_texture(gl, method));
}

/// The influences that the shader's Vertex has room for.
std::size_t gpu_influences(const Avatar& avatar) {
  return avatar.influence_count <= 4 ? 4 : 8;
}

constexpr std::size_t kVertexWords = 4;  ///< without the influences, two words each

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
  out.reserve(avatar.position_bind.size() * (kVertexWords + 2 * influences));
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

/// What belongs to a frame.
struct GpuCuller::Place {
  Place(const GlFunctions& functions, std::size_t corners_bytes)
      : gl(functions),
        palette(gl),
        segments(gl),
        slots(gl),
        corners(gl),
        counts(gl),
        counted(gl, sizeof(Counts)),
        found(gl, kMostSlots * sizeof(Slot)),
        words(gl, kWordsBytes) {
    slots.upload(nullptr, kMostSlots * sizeof(Slot), GL_STREAM_COPY);
    corners.upload(nullptr, corners_bytes, GL_STREAM_COPY);
    corner_texture.emplace(gl, corners.name());
  }
  ~Place() { gl.DeleteSync(fence); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// So that a lane that does not write its word in the next frame is noticed.
  void clear_words(std::size_t of_slots) {
    std::memset(words.data(), 0, of_slots * kSlotLanes * sizeof(std::uint32_t));
  }

  static constexpr std::size_t kWordsBytes = kMostSlots * kSlotLanes * sizeof(std::uint32_t);

  const GlFunctions& gl;
  GlBuffer palette;
  GlBuffer segments;
  GlBuffer slots;
  GlBuffer corners;
  GlBuffer counts;
  GlMappedBuffer counted;                       ///< a copy of `counts`, after the frame
  GlMappedBuffer found;                         ///< a copy of `slots`, likewise
  GlMappedBuffer words;                         ///< shaders/candidates.glsl
  std::optional<CornerTexture> corner_texture;  ///< made when `corners` has its size
  GLsync fence = nullptr;                       ///< null if the GPU has nothing of this place
  std::size_t segment_count = 0;
};

GpuCuller::Programs::Programs(const GlFunctions& gl, const std::string& head)
    : cull(gl, head + "#define ONLY_CULLS 1\n", {{GL_COMPUTE_SHADER, "cull.comp", after_proofs(shaders::kCullComp)}}),
      prove(gl, head + "#define ONLY_CULLS 0\n",
            {{GL_COMPUTE_SHADER, "candidates.comp", after_proofs(shaders::kCandidatesComp)}}) {}

bool GpuCuller::can_hold(const GlFunctions& gl, const Avatar& avatar, const Meshlets& meshlets, Method method) {
  if (meshlets.size() == 0 || meshlets.size() > kMostMeshlets) return false;
  GLint64 block_bytes = 0;
  gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_bytes);
  std::size_t boxes = 0;
  for (std::size_t m = 0; m < meshlets.size(); ++m) boxes += meshlets.rest_boxes(0, m).size();
  const std::size_t vertex_bytes = sizeof(std::uint32_t) * (kVertexWords + 2 * gpu_influences(avatar));
  const std::size_t largest = std::max({meshlets.size() * sizeof(GpuMeshlet), boxes * sizeof(RestBox),
                                        avatar.position_bind.size() * vertex_bytes,
                                        most_places(gl, meshlets, method) * sets_of(method) * sizeof(MeshletCorners)});
  return largest <= static_cast<std::size_t>(block_bytes);
}

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
      timer_(gl_) {
  upload_all(meshlet_buffer_, gpu_meshlets(avatar, meshlets), GL_STATIC_DRAW);
  upload_all(rest_boxes_, all_rest_boxes(meshlets), GL_STATIC_DRAW);
  upload_all(vertices_, gpu_vertices(avatar), GL_STATIC_DRAW);
  programs(false);
  check_gl(gl_, "uploading the avatar");
}

GpuCuller::~GpuCuller() = default;

GpuCuller::Place& GpuCuller::place_at(std::size_t number) {
  std::unique_ptr<Place>& place = places_[number];
  if (place == nullptr) place = std::make_unique<Place>(gl_, most_places_ * sets_of(method_) * sizeof(MeshletCorners));
  return *place;
}

const GpuCuller::Programs& GpuCuller::programs(bool has_spheres) {
  std::optional<Programs>& programs = programs_[has_spheres ? 1 : 0];
  if (programs) return *programs;
  const std::string head = fmt::format(
      "#version 450 core\n{}#define METHOD {}\n#define SPHERES {}\n#define CULLED_ON_GPU 1\n#define LANES {}u\n"
      "#define SLOT_SEGMENTS {}u\n#define GROUP_THREADS {}u\n#define MOST_SLOTS {}u\n#define MOST_PLACES {}u\n"
      "#define SETS {}u\n#define CORNERS {}u\n#define INFLUENCES {}\n",
      shaders::kConstantsH, static_cast<int>(method_), has_spheres ? 1 : 0, kSlotLanes, kSlotSegments, kGpuGroupThreads,
      kMostSlots, most_places_, sets_of(method_), kCorners, gpu_influences(avatar_));
  programs.emplace(gl_, head);
  return *programs;
}

bool GpuCuller::submit(std::size_t place, const DetectorFrame& frame, StageClock* clock) {
  if (frame.segments.empty() || frame.segments.size() > kMostSegments) return false;
  enter_stage(clock, Stage::kUpload);
  const std::optional<Margins> margins = margins_of(frame);
  if (!margins) return false;
  Place& here = place_at(place);
  upload_frame(frame, here);
  const Programs& chosen = programs(std::ranges::any_of(frame.segments, &Segment::is_sphere));
  timer_.time(clock, [&] { start(here, *margins, chosen); });
  here.fence = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl_.ClientWaitSync(here.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);  // so that the GPU begins at once
  return true;
}

/// Returns nothing if nothing is known of the errors, or if a way is too long.
std::optional<GpuCuller::Margins> GpuCuller::margins_of(const DetectorFrame& frame) {
  if (std::max({bind_extent_m_.x, bind_extent_m_.y, bind_extent_m_.z}) > kLargest) return {};
  bounds_.begin(frame, method_);
  if (!std::isfinite(bounds_.pad_m())) return {};
  double reach_m = 0;
  for (const std::vector<SkinMatrix>* palette : {&frame.palette, &frame.palette_before}) {
    const std::optional<glm::dvec3> reach = palette_reach_m(*palette, bind_extent_m_, kLargest);
    if (!reach) return {};
    reach_m = std::max({reach_m, reach->x, reach->y, reach->z});
    if (method_ == Method::kStatic) break;
  }
  for (const Segment& segment : frame.segments) {
    const glm::vec3 way = glm::abs(segment.end - segment.start);
    if (!(static_cast<double>(std::max({way.x, way.y, way.z})) <= kLongestWay * reach_m)) return {};
  }
  const double errors = method_ == Method::kCarried ? kCarriedErrors : 1;
  return Margins{bounds_.pad_m() + kLeast_m, static_cast<float>(reach_m * kCornerError * errors) + kLeast_m};
}

void GpuCuller::upload_frame(const DetectorFrame& frame, Place& place) {
  place.segment_count = frame.segments.size();
  gpu_palette_ = frame.palette;
  if (method_ != Method::kStatic)
    gpu_palette_.insert(gpu_palette_.end(), frame.palette_before.begin(), frame.palette_before.end());
  upload_all(place.palette, gpu_palette_, GL_STREAM_DRAW);
  gpu_segments_.clear();
  for (const Segment& segment : frame.segments) {
    gpu_segments_.emplace_back(segment.start, bounding_radius_m(segment));
    gpu_segments_.emplace_back(segment.end, 0);
  }
  upload_all(place.segments, gpu_segments_, GL_STREAM_DRAW);
  const Counts zeros;
  place.counts.upload(&zeros, sizeof(zeros), GL_STREAM_DRAW);
}

void GpuCuller::start(const Place& place, const Margins& margins, const Programs& programs) {
  const auto bind = [&](GLuint binding, GLuint buffer) {
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
  };
  const GLuint cull = programs.cull.name();
  bind(VESTIGE_BINDING_PALETTE, place.palette.name());
  bind(VESTIGE_BINDING_SEGMENTS, place.segments.name());
  bind(VESTIGE_BINDING_CULLED_CORNERS, place.corners.name());
  bind(VESTIGE_BINDING_CANDIDATES, place.slots.name());
  bind(VESTIGE_BINDING_COUNTS, place.counts.name());
  bind(VESTIGE_BINDING_MESHLETS, meshlet_buffer_.name());
  bind(VESTIGE_BINDING_REST_BOXES, rest_boxes_.name());
  bind(VESTIGE_BINDING_VERTICES, vertices_.name());
  gl_.ProgramUniform1ui(cull, VESTIGE_UNIFORM_SEGMENT_COUNT, static_cast<GLuint>(place.segment_count));
  gl_.ProgramUniform1ui(cull, VESTIGE_UNIFORM_PALETTE_SIZE, static_cast<GLuint>(avatar_.palette.size()));
  gl_.ProgramUniform1f(cull, VESTIGE_UNIFORM_BOX_MARGIN, margins.box_m);
  gl_.UseProgram(cull);
  gl_.DispatchCompute(static_cast<GLuint>(meshlets_.size()), 1, 1);
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);

  bind(VESTIGE_BINDING_FOUND, place.found.name());
  bind(VESTIGE_BINDING_CAPTURED, place.words.name());
  gl_.BindTextureUnit(VESTIGE_TEXTURE_CORNERS, place.corner_texture->name());
  gl_.ProgramUniform1f(programs.prove.name(), VESTIGE_UNIFORM_CORNER_ERROR, margins.corner_m);
  gl_.UseProgram(programs.prove.name());
  gl_.BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, place.counts.name());
  gl_.DispatchComputeIndirect(offsetof(Counts, groups));
  gl_.CopyNamedBufferSubData(place.counts.name(), place.counted.name(), 0, 0, sizeof(Counts));
  gl_.MemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

std::optional<std::span<const CulledPair>> GpuCuller::collect(std::size_t place, StageClock* clock) {
  Place& here = *places_[place];
  enter_stage(clock, Stage::kReadBack);
  await_fence(gl_, std::exchange(here.fence, nullptr), wait_);
  check_gl(gl_, "culling and proving");
  Counts counts;
  std::memcpy(&counts, here.counted.data(), sizeof(counts));
  if (counts.tested != meshlets_.size() * here.segment_count) throw unfinished_shader();
  const bool has_room = counts.slots <= kMostSlots && counts.places <= most_places_;
  if (has_room) {
    if (counts.corners_skinned != counts.places * sets_of(method_) * kCorners) throw unfinished_shader();
    read_pairs(here, counts);
  }
  here.clear_words(std::min<std::size_t>(counts.slots, kMostSlots));
  if (!has_room) return {};
  return pairs_;
}

void GpuCuller::abandon() {
  gl_.Finish();
  for (const std::unique_ptr<Place>& place : places_) {
    if (place == nullptr) continue;
    gl_.DeleteSync(std::exchange(place->fence, nullptr));
    place->clear_words(kMostSlots);
  }
}

/// Slots come in any order.
void GpuCuller::read_pairs(const Place& place, const Counts& counts) {
  const auto* found = reinterpret_cast<const Slot*>(place.found.data());
  const auto* words = reinterpret_cast<const std::array<std::uint32_t, kSlotLanes>*>(place.words.data());
  pairs_.clear();
  for (std::size_t i = 0; i < counts.slots; ++i) {
    const Slot& slot = found[i];
    if (slot.count == 0 || slot.count > kSlotSegments || slot.meshlet >= meshlets_.size()) throw unfinished_shader();
    std::array<std::uint32_t, kSlotSegments> bits;
    unpack_words(words[i], slot.count, bits.data());
    const std::uint32_t all = bits_of(meshlets_.triangles(slot.meshlet).size());
    for (std::size_t k = 0; k < slot.count; ++k) {
      if (slot.segments[k] >= place.segment_count) throw unfinished_shader();
      pairs_.push_back({slot.meshlet, slot.segments[k], bits[k] & all});
    }
  }
  if (pairs_.size() != counts.pairs) throw unfinished_shader();
  std::ranges::sort(pairs_, {}, [](const CulledPair& pair) { return std::pair(pair.meshlet, pair.segment); });
}

}  // namespace vestige
