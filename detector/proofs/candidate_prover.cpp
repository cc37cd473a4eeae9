#include "detector/proofs/candidate_prover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <glm/vec4.hpp>
#include <string>
#include <utility>

#include "detector/proofs/candidate_words.hpp"
#include "shaders/constants.h"
#include "shaders/shaders.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kBlockSlots = 256;
constexpr std::size_t kBlockSegments = 384;

/// Blocks, and meshlets with two sets of corners, that are proven at once.
constexpr std::size_t kMostBlocks = 64;
constexpr std::size_t kMostMeshlets = 1024;

/// std140 layout of the shader's Candidates.
struct Slot {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t place = 0;
  std::uint32_t unused = 0;
};
struct GpuSegment {
  glm::vec4 start;  ///< w: bounding_radius_m
  glm::vec4 end;
};

}  // namespace

struct CandidateProver::Block {
  std::array<Slot, kBlockSlots> slots;
  std::array<GpuSegment, kBlockSegments> segments;
};

struct CandidateProver::Place {
  /// The number of things in a block: the input of one draw or dispatch.
  struct Filled {
    std::size_t slots = 0;
    std::size_t segments = 0;
  };

  Place(const GlFunctions& functions, std::size_t corners_bytes)
      : gl(functions),
        corners(gl, corners_bytes),
        corner_texture(gl, corners.name()),
        blocks(gl, kMostBlocks * sizeof(Block)),
        words(gl, kWordsBytes) {}
  ~Place() { gl.DeleteSync(fence); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  void forget() {
    filled.clear();
    slot_segments.clear();
    meshlets = 0;
    has_spheres = false;
  }
  void read_words();

  static constexpr std::size_t kWordsBytes = kMostBlocks * kBlockSlots * kSlotLanes * sizeof(std::uint32_t);

  const GlFunctions& gl;
  GlMappedBuffer corners;
  CornerTexture corner_texture;
  GlMappedBuffer blocks;
  GlMappedBuffer words;
  GLsync fence = nullptr;  ///< null if the GPU has nothing of this place
  bool has_spheres = false;
  std::size_t meshlets = 0;
  std::vector<Filled> filled;  ///< the blocks
  std::vector<std::size_t> slot_segments;
  std::vector<std::uint32_t> bits;  ///< what `finish` returns
};

CandidateProver::CandidateProver(const GlContext& context, const ProverOptions& options)
    : gl_(context.gl()),
      options_(options),
      wait_(context.info().software ? FenceWait::kAsleep : FenceWait::kActive),
      most_meshlets_(std::min(kMostMeshlets, most_meshlets_in_texture(gl_, options.method))),
      nowhere_(gl_, PlaneSet()),
      timer_(gl_) {
  static_assert(sizeof(Block) == 16384);  // the size that every driver allows for a uniform block
  gl_.CreateVertexArrays(1, &vertex_array_);
  nowhere_.begin(1);
  program(false);
  check_gl(gl_, "preparing the candidates' shaders");
}

CandidateProver::~CandidateProver() {
  gl_.DeleteVertexArrays(1, &vertex_array_);
}

const GlProgram& CandidateProver::program(bool has_spheres) {
  std::optional<GlProgram>& program = programs_[has_spheres ? 1 : 0];
  if (program) return *program;
  const std::string head = fmt::format(
      "#version 450 core\n{}#define METHOD {}\n#define SPHERES {}\n#define BLOCK_SLOTS {}\n#define BLOCK_SEGMENTS {}\n"
      "#define CULLED_ON_GPU 0\n#define ONLY_CULLS 0\n#define LANES {}u\n#define SLOT_SEGMENTS {}u\n#define "
      "GROUP_THREADS {}u\n",
      shaders::kConstantsH, static_cast<int>(options_.method), has_spheres ? 1 : 0, kBlockSlots, kBlockSegments,
      kSlotLanes, kSlotSegments, options_.as_on_gpu ? kGpuGroupThreads : kSlotLanes);
  const std::string proofs(shaders::kCandidatesGlsl);
  if (options_.stage == ProofStage::kCompute) {
    const std::string source = proofs + std::string(shaders::kCandidatesComp);
    program.emplace(gl_, head, std::initializer_list<GlProgram::Stage>{{GL_COMPUTE_SHADER, "candidates.comp", source}});
  } else {
    const std::string source = proofs + std::string(shaders::kCandidatesGeom);
    program.emplace(
        gl_, head,
        std::initializer_list<GlProgram::Stage>{{GL_VERTEX_SHADER, "candidates.vert", shaders::kCandidatesVert},
                                                {GL_GEOMETRY_SHADER, "candidates.geom", source}});
  }
  return *program;
}

void CandidateProver::begin(std::size_t place, StageClock* clock) {
  clock_ = clock;
  enter_stage(clock_, Stage::kUpload);
  std::unique_ptr<Place>& here = places_[place];
  if (here == nullptr)
    here = std::make_unique<Place>(gl_, most_meshlets_ * sets_of(options_.method) * sizeof(MeshletCorners));
  filling_ = here.get();
  gl_.BindTextureUnit(VESTIGE_TEXTURE_CORNERS, here->corner_texture.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, VESTIGE_BINDING_CAPTURED, here->words.name());
  if (options_.stage == ProofStage::kGeometry) {
    gl_.BindVertexArray(vertex_array_);
    nowhere_.bind();  // a draw without any framebuffer fails in a surfaceless context
    gl_.Enable(GL_RASTERIZER_DISCARD);
  }
  here->bits.clear();
}

void CandidateProver::add(const MeshletCorners& now, const MeshletCorners& before, std::span<const Segment> segments,
                          std::span<const std::uint32_t> numbers) {
  Place& place = *filling_;
  while (!numbers.empty()) {
    if (place.meshlets == most_meshlets_) prove();
    auto* corners = reinterpret_cast<MeshletCorners*>(place.corners.data()) + place.meshlets * sets_of(options_.method);
    *corners = now;
    if (options_.method != Method::kStatic) corners[1] = before;
    ++place.meshlets;
    while (!numbers.empty()) {
      const std::size_t count = std::min(numbers.size(), kSlotSegments);
      const auto& filled = place.filled;
      if (filled.empty() || filled.back().slots == kBlockSlots || filled.back().segments + count > kBlockSegments) {
        if (filled.size() == kMostBlocks) {
          prove();
          break;  // whose corners are gone
        }
        place.filled.emplace_back();
      }
      add_slot(segments, numbers.first(count));
      numbers = numbers.subspan(count);
    }
  }
}

void CandidateProver::add_slot(std::span<const Segment> segments, std::span<const std::uint32_t> numbers) {
  Place& place = *filling_;
  Place::Filled& filled = place.filled.back();
  Block& block = reinterpret_cast<Block*>(place.blocks.data())[place.filled.size() - 1];
  place.slot_segments.push_back(numbers.size());
  block.slots[filled.slots++] = {.first = static_cast<std::uint32_t>(filled.segments),
                                 .count = static_cast<std::uint32_t>(numbers.size()),
                                 .place = static_cast<std::uint32_t>(place.meshlets - 1)};
  for (const std::uint32_t number : numbers) {
    const Segment& segment = segments[number];
    place.has_spheres = place.has_spheres || segment.is_sphere();
    block.segments[filled.segments++] = {glm::vec4(segment.start, bounding_radius_m(segment)),
                                         glm::vec4(segment.end, 0)};
  }
}

void CandidateProver::start() {
  Place& place = *filling_;
  if (place.filled.empty()) return;
  const GlProgram& shader = program(place.has_spheres);
  gl_.UseProgram(shader.name());
  timer_.time(clock_, [&] {
    for (std::size_t i = 0; i < place.filled.size(); ++i) start_block(shader, i);
  });
  enter_stage(clock_, Stage::kReadBack);
  gl_.MemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  place.fence = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl_.ClientWaitSync(place.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0);  // so that the GPU begins at once
}

void CandidateProver::prove() {
  start();
  wait(*filling_);
  enter_stage(clock_, Stage::kUpload);
}

std::span<const std::uint32_t> CandidateProver::finish(std::size_t place) {
  enter_stage(clock_, Stage::kReadBack);
  wait(*places_[place]);
  return places_[place]->bits;
}

void CandidateProver::abandon() {
  for (const std::unique_ptr<Place>& place : places_) {
    if (place == nullptr) continue;
    if (place->fence != nullptr) {
      gl_.Finish();
      gl_.DeleteSync(std::exchange(place->fence, nullptr));
    }
    std::memset(place->words.data(), 0, Place::kWordsBytes);
    place->forget();
  }
}

void CandidateProver::start_block(const GlProgram& shader, std::size_t number) {
  const auto slots = static_cast<GLuint>(filling_->filled[number].slots);
  gl_.BindBufferRange(GL_UNIFORM_BUFFER, VESTIGE_BINDING_CANDIDATES, filling_->blocks.name(),
                      static_cast<GLintptr>(number * sizeof(Block)), static_cast<GLsizeiptr>(sizeof(Block)));
  gl_.ProgramUniform1ui(shader.name(), VESTIGE_UNIFORM_FIRST_SLOT, static_cast<GLuint>(number * kBlockSlots));
  if (options_.stage == ProofStage::kGeometry) {
    gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(slots * kSlotLanes));
    return;
  }
  gl_.ProgramUniform1ui(shader.name(), VESTIGE_UNIFORM_SLOT_COUNT, slots);
  constexpr GLuint kGroupSlots = kGpuGroupThreads / kSlotLanes;
  gl_.DispatchCompute(options_.as_on_gpu ? (slots + kGroupSlots - 1) / kGroupSlots : 1, 1, 1);
}

/// Waits for what the GPU has of a place, and takes its bits.
void CandidateProver::wait(Place& place) {
  if (place.fence == nullptr) return;
  await_fence(gl_, std::exchange(place.fence, nullptr), wait_);
  check_gl(gl_, "proving candidates");
  place.read_words();
  place.forget();
}

/// Clears each word that it reads, so that a lane that does not write it is noticed.
void CandidateProver::Place::read_words() {
  auto* read_from = reinterpret_cast<std::array<std::uint32_t, kSlotLanes>*>(words.data());
  auto segments = slot_segments.begin();
  for (const Filled& block : filled) {
    for (std::size_t slot = 0; slot < block.slots; ++slot, ++segments) {
      const std::array<std::uint32_t, kSlotLanes> read = std::exchange(read_from[slot], {});
      bits.resize(bits.size() + *segments);
      unpack_words(read, *segments, bits.data() + bits.size() - *segments);
    }
    read_from += kBlockSlots;
  }
}

}  // namespace vestige
