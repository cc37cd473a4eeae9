#include "detector/detectors/gpu_compute_detector.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/proofs/gpu_culler.hpp"
#include "detector/proofs/in_flight.hpp"
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
    if (GpuCuller::can_hold(context_->gl(), avatar, meshlets_, method_))
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
    DetectorWork work;
    detect_all({&frame, 1}, {&row, 1}, {&work, 1});
    return work;
  }

  void detect_all(std::span<const DetectorFrame> frames, std::span<ContactRow> rows,
                  std::span<DetectorWork> work) override try {
    keep_in_flight(
        frames.size(),
        [&](std::size_t i, std::size_t place) {
          const Run run = run_of(frames[i]);
          const bool on_gpu = submit(frames[i], run, place);
          flights_[place] = {.frame = &frames[i], .row = &rows[i], .work = &work[i], .run = run, .on_gpu = on_gpu};
          return true;
        },
        [&](std::size_t place) { finish(place); });
  } catch (...) {
    abandon();
    throw;
  }

  /// Returns the vertices that the detector decides on, which the CPU skins.
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  /// Frames one after another, up to the next multiple of `run_length()`.
  struct Run {
    std::uint64_t sequence = 0;  ///< of frames without a gap, in the order in which they were given
    std::uint64_t number = 0;    ///< in the trace
    bool operator==(const Run&) const = default;
  };
  /// A frame, and where its results go.
  struct Flight {
    const DetectorFrame* frame = nullptr;
    ContactRow* row = nullptr;
    DetectorWork* work = nullptr;
    Run run;
    bool on_gpu = false;
  };

  /// Returns the run that the frame belongs to: the one before goes on only where the frame follows.
  Run run_of(const DetectorFrame& frame) {
    if (frame.index != next_index_) ++sequences_;
    next_index_ = frame.index + 1;
    return {sequences_, frame.index / run_length()};
  }

  bool submit(const DetectorFrame& frame, const Run& run, std::size_t place) {
    if (!culler_ || run == crowded_run_) return false;
    context_->make_current();
    return culler_->submit(place, frame, stage_clock());
  }

  /// All frames of the CPU come here, too, so that they are in order.
  void finish(std::size_t place) {
    const Flight& flight = flights_[place];
    const DetectorFrame& frame = *flight.frame;
    if (flight.on_gpu) {
      context_->make_current();
      const std::optional<std::span<const CulledPair>> pairs = culler_->collect(place, stage_clock());
      if (!pairs) crowded_run_ = flight.run;
      if (pairs && flight.run != crowded_run_) {
        *flight.work = decide(frame, *pairs, *flight.row);
        return;
      }
    }
    *flight.work = cpu_->detect(frame, *flight.row);
    flight.work->pairs_captured = flight.work->pairs_meeting;
  }

  void abandon() {
    if (!culler_) return;
    try {
      context_->make_current();
    } catch (const Error&) {
      return;  // the context is lost, together with everything in it
    }
    culler_->abandon();
  }

  DetectorWork decide(const DetectorFrame& frame, std::span<const CulledPair> pairs, ContactRow& row) {
    row.clear(frame.columns);
    if (pairs.empty()) return {.frames_skipped = 1};
    DetectorWork work;
    for (std::span<const CulledPair> left = pairs; !left.empty();) {
      std::size_t count = 1;
      while (count < left.size() && left[count].meshlet == left[0].meshlet) ++count;
      decide_meshlet(frame, left.first(count), row, work);
      left = left.subspan(count);
    }
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  /// Decides the pairs of one meshlet that were not proven to miss.
  void decide_meshlet(const DetectorFrame& frame, std::span<const CulledPair> pairs, ContactRow& row,
                      DetectorWork& work) {
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
  std::optional<GpuCuller> culler_;  ///< made when the context is current, if it can hold the avatar
  std::array<Flight, kMostInFlight> flights_;
  std::uint64_t sequences_ = 0;
  std::uint64_t next_index_ = 0;
  /// A run of which a frame had more pairs than there is room for: the CPU takes the rest of it.
  std::optional<Run> crowded_run_;
};

}  // namespace

std::unique_ptr<Detector> make_gpu_compute_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                    const ActuatorMap& map, const DetectorOptions& options) {
  return std::make_unique<GpuComputeDetector>(std::move(context), avatar, map, options);
}

}  // namespace vestige
