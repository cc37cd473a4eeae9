#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/frame.hpp"
#include "detector/gl/collision_texture.hpp"
#include "detector/gl/draw_timer.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/method.hpp"
#include "detector/proofs/in_flight.hpp"
#include "detector/stages.hpp"

namespace vestige {

/// The stage of OpenGL that runs shaders/candidates.glsl: its proofs are the same in both.
enum class ProofStage { kGeometry, kCompute };

struct ProverOptions {
  ProofStage stage = ProofStage::kCompute;
  Method method = Method::kStatic;
  /// Divide the work as on a GPU: many small groups of threads. Otherwise as for a software renderer, where each group
  /// costs time.
  bool as_on_gpu = false;
};

/// Proves by shaders which segments miss which triangles of meshlets. Reads and writes memory that the driver shares,
/// so no call copies. Belongs to a context, which must be current at every call. Several frames may be in flight, each
/// in a place of its own, below kMostInFlight.
class CandidateProver {
 public:
  CandidateProver(const GlContext& context, const ProverOptions& options);
  ~CandidateProver();
  CandidateProver(const CandidateProver&) = delete;
  CandidateProver& operator=(const CandidateProver&) = delete;

  /// Begins a frame in a place that no other frame is in. Also sets what another detector of the context may have
  /// changed. `clock` may be null.
  void begin(std::size_t place, StageClock* clock);

  /// Adds to the frame the pairs of a meshlet's triangles, skinned now and before, and the segments with these numbers.
  void add(const MeshletCorners& now, const MeshletCorners& before, std::span<const Segment> segments,
           std::span<const std::uint32_t> numbers);

  /// Hands the frame to the GPU, without waiting for it.
  void start();

  /// Waits for the frame in this place. Returns, for each number that was added, in order, bits of the meshlet's
  /// triangles: 0 if that segment surely misses the triangle. Valid until the place's next `begin`. Throws `Error`
  /// after an OpenGL error.
  std::span<const std::uint32_t> finish(std::size_t place);

  /// Waits for all frames in flight and forgets them. After an error, this makes all places free.
  void abandon();

 private:
  /// The input of one draw or dispatch.
  struct Block;
  /// What a frame in flight needs for itself.
  struct Place;

  void add_slot(std::span<const Segment> segments, std::span<const std::uint32_t> numbers);
  /// Proves what was added to the frame so far, and makes room.
  void prove();
  void start_block(const GlProgram& shader, std::size_t number);
  void wait(Place& place);
  const GlProgram& program(bool has_spheres);

  const GlFunctions& gl_;
  ProverOptions options_;
  FenceWait wait_;             ///< a GPU is done before the system would wake this thread
  std::size_t most_meshlets_;  ///< whose corners fit
  CollisionTexture nowhere_;
  DrawTimer timer_;
  std::array<std::optional<GlProgram>, 2> programs_;  ///< for points alone, and for spheres, too
  GLuint vertex_array_ = 0;

  StageClock* clock_ = nullptr;
  std::array<std::unique_ptr<Place>, kMostInFlight> places_;  ///< made when a frame first needs them
  Place* filling_ = nullptr;                                  ///< that of the frame that began last
};

}  // namespace vestige
