#include "detector/detectors/gpu_compute_detector.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/coherence/coherent_search.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/detectors/gpu_culler.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/skinning.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

class GpuComputeDetector final : public Detector {
 public:
  GpuComputeDetector(std::shared_ptr<GlContext> context, const Avatar& avatar, const ActuatorMap& map,
                     const DetectorOptions& options)
      : context_(std::move(context)),
        avatar_(avatar),
        method_(options.method),
        finder_(avatar, map, options),
        meshlets_(avatar),
        skin_(avatar, meshlets_),
        cpu_(make_cpu_detector(avatar, map, options)) {
    context_->make_current();
    culler_.emplace(*context_, avatar, meshlets_, method_);
  }

  ~GpuComputeDetector() override {
    try {
      context_->make_current();
    } catch (const Error&) {
      // The context is lost, together with everything in it.
    }
  }

  const char* name() const override { return "compute"; }
  Method method() const override { return method_; }
  Skip skip() const override { return Skip::kOn; }
  /// That of `cpu_`: the shaders remember nothing.
  std::uint64_t run_length() const override { return cpu_->run_length(); }
  GlInfo gl_info() const override { return context_->info(); }

  void time_stages(StageClock* clock) override {
    Detector::time_stages(clock);
    cpu_->time_stages(clock);
  }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    if (frame.segments.empty() || !submit(frame)) return cpu_->detect(frame, row);
    return collect(frame, row);
  }

  /// Returns the vertices that the detector decides on, which the CPU skins.
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  bool submit(const DetectorFrame& frame) {
    context_->make_current();
    return culler_->submit(frame, stage_clock());
  }

  /// Completes the frame that was submitted.
  DetectorWork collect(const DetectorFrame& frame, ContactRow& row) {
    context_->make_current();
    const std::optional<std::span<const CulledPair>> pairs = culler_->collect(stage_clock());
    if (!pairs) return cpu_->detect(frame, row);
    row.clear(frame.columns);
    if (pairs->empty()) return {.frames_skipped = 1};
    DetectorWork work;
    for (std::span<const CulledPair> left = *pairs; !left.empty();) {
      std::size_t count = 1;
      while (count < left.size() && left[count].meshlet == left[0].meshlet) ++count;
      decide(frame, left.first(count), row, work);
      left = left.subspan(count);
    }
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  /// Decides the pairs of one meshlet that were not proven to miss.
  void decide(const DetectorFrame& frame, std::span<const CulledPair> pairs, ContactRow& row, DetectorWork& work) {
    const std::span<const std::uint32_t> triangles = meshlets_.triangles(pairs[0].meshlet);
    ++work.meshlets_skinned;
    work.triangles_tested += triangles.size();
    work.pairs_tested += triangles.size() * pairs.size();
    bool is_skinned = false;
    for (const CulledPair& pair : pairs) {
      if (pair.triangles == 0) continue;
      if (!std::exchange(is_skinned, true)) skin(frame, pair.meshlet);
      work.pairs_captured += static_cast<std::uint64_t>(std::popcount(pair.triangles));
      enter(Stage::kDecision);
      const MeshletPlaces places = {method_ == Method::kStatic ? now_ : before_, now_, triangles};
      finder_.offer(frame, places, frame.segments[pair.segment], pair.triangles, row);
    }
  }

  void skin(const DetectorFrame& frame, std::uint32_t meshlet) {
    enter(Stage::kSkinning);
    skin_.skin(meshlet, frame.palette, now_);
    if (method_ != Method::kStatic) skin_.skin(meshlet, frame.palette_before, before_);
  }

  std::shared_ptr<GlContext> context_;
  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  Meshlets meshlets_;
  MeshletSkin skin_;
  MeshletCorners now_;
  MeshletCorners before_;
  std::unique_ptr<Detector> cpu_;    ///< for frames that the culler does not take
  std::optional<GpuCuller> culler_;  ///< made when the context is current
};

}  // namespace

std::unique_ptr<Detector> make_gpu_compute_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                    const ActuatorMap& map, const DetectorOptions& options) {
  return std::make_unique<GpuComputeDetector>(std::move(context), avatar, map, options);
}

}  // namespace vestige
