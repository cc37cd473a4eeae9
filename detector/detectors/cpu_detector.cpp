#include <cstdint>
#include <span>
#include <vector>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlet_triangles.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/broad/triangle_boxes.hpp"
#include "detector/coherence/candidate_patches.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/contact_finder.hpp"
#include "detector/detectors/make_detectors.hpp"

namespace vestige {

namespace {

/// Tests every segment against every triangle.
class CpuDetector final : public Detector {
 public:
  CpuDetector(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), method_(options.method), finder_(avatar, map, options) {}

  const char* name() const override { return "cpu"; }
  Method method() const override { return method_; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {};
    enter(Stage::kSkinning);
    skin_.skin(avatar_, frame, method_);
    enter(Stage::kCandidates);
    boxes_.build(avatar_, skin_, method_);
    enter(Stage::kTest);
    for (const Segment& segment : frame.segments)
      boxes_.meet(segment, [&](std::uint32_t triangle) {
        enter(Stage::kDecision);
        finder_.offer(frame, moving_corners(avatar_, skin_, method_, triangle), segment, triangle, row[segment.column]);
        enter(Stage::kTest);
      });
    DetectorWork work = {.pairs_tested = frame.segments.size() * avatar_.triangles.size(),
                         .triangles_tested = avatar_.triangles.size()};
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  SkinMotion skin_;
  TriangleBoxes boxes_;
};

/// Tests every segment against the meshlets that it may meet. Only those meshlets are skinned.
class SkippingCpuDetector final : public Detector {
 public:
  SkippingCpuDetector(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar),
        method_(options.method),
        finder_(avatar, map, options),
        meshlets_(avatar),
        candidates_(avatar, meshlets_, options.method) {}

  const char* name() const override { return "cpu"; }
  Method method() const override { return method_; }
  Skip skip() const override { return Skip::kOn; }
  std::uint64_t run_length() const override { return CoherentSearch::kRestart; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {.frames_skipped = frame.out_of_reach > 0 ? 1U : 0U};
    candidates_.find(frame, stage_clock());
    DetectorWork work = candidates_.work();
    for (std::size_t i = 0; i < candidates_.touched().size(); ++i) test(frame, i, row);
    enter(Stage::kDecision);
    finder_.finish(frame, row, work);
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  void test(const DetectorFrame& frame, std::size_t number, ContactRow& row) {
    enter(Stage::kSkinning);
    candidates_.skin_touched(frame, number);
    enter(Stage::kTest);
    const TouchedMeshlet& touched = candidates_.touched()[number];
    const std::span<const std::uint32_t> numbers = candidates_.segments(touched);
    const std::span<const std::uint32_t> triangles = meshlets_.triangles(touched.meshlet);
    const MeshletPlaces meshlet = {candidates_.before(number), candidates_.now(number), triangles};
    meets_.resize(numbers.size());
    candidates_.triangles(number).meet(candidates_.ways(), numbers, meets_.data());
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const Segment& segment = frame.segments[numbers[k]];
      const std::uint32_t bits = meets_[k] & bits_of(triangles.size());
      if (bits == 0) continue;
      enter(Stage::kDecision);
      finder_.offer(frame, meshlet, segment, bits, row);
    }
  }

  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  Meshlets meshlets_;
  CandidatePatches candidates_;
  std::vector<std::uint32_t> meets_;  ///< for each segment that may meet a meshlet: bits of the triangles
};

}  // namespace

std::unique_ptr<Detector> make_cpu_detector(const Avatar& avatar, const ActuatorMap& map,
                                            const DetectorOptions& options) {
  if (options.skip == Skip::kOn) return std::make_unique<SkippingCpuDetector>(avatar, map, options);
  return std::make_unique<CpuDetector>(avatar, map, options);
}

}  // namespace vestige
