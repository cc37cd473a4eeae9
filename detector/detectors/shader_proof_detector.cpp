#include "detector/detectors/shader_proof_detector.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/coherence/candidate_patches.hpp"
#include "detector/coherence/found_patches.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/detectors/gpu_compute_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/proofs/in_flight.hpp"
#include "detector/skinning.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// A frame without a candidate pair needs no OpenGL call.
///
/// Measured on llvmpipe, processor time per frame, 40 and 100 colliders of a swarm, `geometry`: one indirect draw
/// command for each meshlet, skinned by the vertex shader, 236 and 418 us; one draw with the touched meshlets' indices,
/// 214 and 477 us; skinned by the CPU, a point for each triangle, 67 and 145 us. A point for four triangles, whose
/// corners lie in a texture buffer, and words of bits in place of an atomic counter, took less than half of that again
/// (candidates.glsl).
class ShaderProofDetector final : public Detector {
 public:
  ShaderProofDetector(std::shared_ptr<GlContext> context, ProofStage stage, const Avatar& avatar,
                      const ActuatorMap& map, const DetectorOptions& options)
      : context_(std::move(context)),
        stage_(stage),
        avatar_(avatar),
        method_(options.method),
        skip_(options.skip),
        finder_(avatar, map, options),
        meshlets_(avatar),
        candidates_(avatar, meshlets_, options.method) {
    context_->make_current();
    prover_.emplace(*context_, ProverOptions{.stage = stage,
                                             .method = options.method,
                                             .as_on_gpu = options.as_on_gpu || !context_->info().software});
  }

  ~ShaderProofDetector() override {
    try {
      context_->make_current();
    } catch (const Error&) {
      // The context is lost, together with everything in it.
    }
  }

  const char* name() const override { return stage_ == ProofStage::kCompute ? "compute" : "geometry"; }
  Method method() const override { return method_; }
  Skip skip() const override { return skip_; }
  std::uint64_t run_length() const override { return skip_ == Skip::kOn ? CoherentSearch::kRestart : 1; }
  GlInfo gl_info() const override { return context_->info(); }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    DetectorWork work;
    detect_all({&frame, 1}, {&row, 1}, {&work, 1});
    return work;
  }

  void detect_all(std::span<const DetectorFrame> frames, std::span<ContactRow> rows,
                  std::span<DetectorWork> work) override try {
    keep_in_flight(
        frames.size(),
        [&](std::size_t i, std::size_t place) {
          Flight& flight = flights_[place];
          flight.frame = &frames[i];
          flight.row = &rows[i];
          flight.work = &work[i];
          return start(place);
        },
        [&](std::size_t place) { finish(place); });
  } catch (...) {
    abandon();
    throw;
  }

  /// Returns the vertices that the detector works with, which the CPU skins.
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  /// A frame whose misses are being proven, and where its results go.
  struct Flight {
    const DetectorFrame* frame = nullptr;
    ContactRow* row = nullptr;
    DetectorWork* work = nullptr;
    FoundPatches found = {};
  };

  /// Returns whether the frame in this place has anything to prove.
  bool start(std::size_t place) {
    Flight& flight = flights_[place];
    const DetectorFrame& frame = *flight.frame;
    flight.row->clear(frame.columns);
    if (frame.segments.empty()) {
      *flight.work = {.frames_skipped = frame.out_of_reach > 0 ? 1U : 0U};
      return false;
    }
    if (skip_ == Skip::kOn)
      candidates_.find(frame, stage_clock());
    else
      candidates_.take_all(frame, stage_clock());
    *flight.work = candidates_.work();
    if (candidates_.touched().empty()) return false;
    prove(frame, place);
    candidates_.swap_found(flight.found);
    return true;
  }

  void prove(const DetectorFrame& frame, std::size_t place) {
    context_->make_current();
    // Otherwise the shader takes the ends' times for those of the frame.
    const std::span<const Segment> tested =
        method_ == Method::kStatic ? candidates_.ways().segments : std::span(frame.segments);
    enter(Stage::kSkinning);
    for (std::size_t i = 0; i < candidates_.touched().size(); ++i) candidates_.skin_touched(frame, i);
    prover_->begin(place, stage_clock());
    for (std::size_t i = 0; i < candidates_.touched().size(); ++i)
      prover_->add(candidates_.now(i), candidates_.before(i), tested, candidates_.segments(candidates_.touched()[i]));
    prover_->start();
  }

  void abandon() {
    try {
      context_->make_current();
    } catch (const Error&) {
      return;  // the context is lost, together with everything in it
    }
    prover_->abandon();
  }

  void finish(std::size_t place) {
    const Flight& flight = flights_[place];
    flight.work->pairs_captured = offer(flight, prover_->finish(place));
    finder_.finish(*flight.frame, *flight.row, *flight.work);
  }

  /// Decides the pairs that were not proven to miss. Returns their number.
  std::uint64_t offer(const Flight& flight, std::span<const std::uint32_t> bits) {
    enter(Stage::kDecision);
    const FoundPatches& found = flight.found;
    std::uint64_t pairs = 0;
    auto next = bits.begin();
    for (std::size_t i = 0; i < found.touched.size(); ++i) {
      const TouchedMeshlet& touched = found.touched[i];
      const std::span<const std::uint32_t> triangles = meshlets_.triangles(touched.meshlet);
      const MeshletPlaces meshlet = {found.before_of(i), found.now_of(i), triangles};
      for (const std::uint32_t number : found.segments(touched)) {
        const std::uint32_t mine = *next++ & bits_of(triangles.size());
        if (mine == 0) continue;
        pairs += static_cast<std::uint64_t>(std::popcount(mine));
        finder_.offer(*flight.frame, meshlet, flight.frame->segments[number], mine, *flight.row);
      }
    }
    return pairs;
  }

  std::shared_ptr<GlContext> context_;
  ProofStage stage_;
  const Avatar& avatar_;
  Method method_;
  Skip skip_;
  ContactFinder finder_;
  Meshlets meshlets_;
  CandidatePatches candidates_;
  std::array<Flight, kMostInFlight> flights_;
  std::optional<CandidateProver> prover_;  ///< made when the context is current
};

}  // namespace

std::unique_ptr<Detector> make_shader_proof_detector(std::shared_ptr<GlContext> context, ProofStage stage,
                                                     const Avatar& avatar, const ActuatorMap& map,
                                                     const DetectorOptions& options) {
  return std::make_unique<ShaderProofDetector>(std::move(context), stage, avatar, map, options);
}

std::unique_ptr<Detector> make_compute_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                const ActuatorMap& map, const DetectorOptions& options) {
  require_proofs("compute", context->info());
  const bool culls_on_gpu =
      options.culling == Culling::kFastest ? !context->info().software : options.culling == Culling::kGpu;
  if (options.skip == Skip::kOn && culls_on_gpu)
    return make_gpu_compute_detector(std::move(context), avatar, map, options);
  return make_shader_proof_detector(std::move(context), ProofStage::kCompute, avatar, map, options);
}

}  // namespace vestige
