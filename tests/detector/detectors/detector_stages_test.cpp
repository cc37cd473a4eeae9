// Where each detector's time goes, and that asking changes nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "detector/detectors/embree_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/stages.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;
using ::testing::ElementsAreArray;

struct StagesOf {
  const char* name;
  std::unique_ptr<Detector> (*make)(const Avatar&, const ActuatorMap&, const DetectorOptions&);
  Skip skip;
  std::vector<std::string> stages;  ///< without "wait", which only a driver with a timer has
};

std::unique_ptr<Detector> timed_embree(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_embree_detector(EmbreeMode::kRobust, avatar, map, options);
}
std::unique_ptr<Detector> timed_paper(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_paper_detector(test::make_context(), avatar, map, options);
}
template <Culling kCulling>
std::unique_ptr<Detector> timed_compute(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  DetectorOptions culling = options;
  culling.culling = kCulling;
  return make_compute_detector(test::make_context(), avatar, map, culling);
}

std::unique_ptr<Detector> timed_geometry(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_geometry_detector(test::make_context(), avatar, map, options);
}

class DetectorStages : public ::testing::TestWithParam<StagesOf> {};

TEST_P(DetectorStages, AreThoseOfItsWorkAndTimingThemChangesNoBit) {
  constexpr std::uint32_t kColliders = 12;
  const auto scene = test::scene("hug", builtin_avatar(), kColliders, 8, 20);
  const auto detector = GetParam().make(builtin_avatar(), builtin_map(),
                                        {Surface::kAll, kHashedPlanes, Method::kStatic, GetParam().skip});
  const test::SceneRun untimed = test::run_scene(scene, builtin_avatar(), kColliders, *detector);
  ASSERT_GT(untimed.contacts(), 0U);

  std::vector<std::uint32_t> ids(kColliders);
  std::iota(ids.begin(), ids.end(), 0U);
  StageClock clock;
  detector->time_stages(&clock);
  DetectionRun detection(builtin_avatar(), ids, *detector);
  TextureHash hash;
  const auto start = std::chrono::steady_clock::now();
  for (const TraceFrame& frame : scene) {
    detection.step(frame);
    hash.add(detection.row());
  }
  const std::chrono::duration<double, std::micro> wall = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(hash.hex(), hash_of(untimed));

  std::vector<std::string> names;
  double total_us = 0;
  for (const StageTime& time : clock.times()) {
    total_us += time.us;
    if (time.stage != Stage::kWait) names.emplace_back(kStageNames[static_cast<std::size_t>(time.stage)]);
  }
  EXPECT_THAT(names, ElementsAreArray(GetParam().stages));
  EXPECT_GT(total_us, 0);
  EXPECT_LE(total_us, wall.count());
  EXPECT_EQ(clock.drawn_by() == DrawnBy::kNothing, detector->gl_info().context.empty());

  detector->time_stages(nullptr);
  clock.reset();
  EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), kColliders, *detector)), hash_of(untimed));
  EXPECT_TRUE(clock.times().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Each, DetectorStages,
    ::testing::Values(
        StagesOf{"cpu", make_cpu_detector, Skip::kOff, {"pose", "candidates", "skinning", "test", "decision"}},
        StagesOf{"cpu_skipping", make_cpu_detector, Skip::kOn, {"pose", "candidates", "skinning", "test", "decision"}},
        StagesOf{"exact", make_exact_detector, Skip::kOff, {"pose", "skinning", "decision"}},
        StagesOf{"embree", timed_embree, Skip::kOff, {"pose", "candidates", "skinning", "test", "decision"}},
        StagesOf{"paper", timed_paper, Skip::kOff, {"pose", "upload", "draw", "read_back"}},
        StagesOf{"geometry", timed_geometry, Skip::kOff, {"pose", "upload", "draw", "read_back", "decision"}},
        StagesOf{"geometry_skipping",
                 timed_geometry,
                 Skip::kOn,
                 {"pose", "candidates", "skinning", "upload", "draw", "read_back", "decision"}},
        StagesOf{"compute",
                 timed_compute<Culling::kCpu>,
                 Skip::kOff,
                 {"pose", "skinning", "upload", "draw", "read_back", "decision"}},
        StagesOf{"compute_skipping",
                 timed_compute<Culling::kCpu>,
                 Skip::kOn,
                 {"pose", "candidates", "skinning", "upload", "draw", "read_back", "decision"}},
        StagesOf{"compute_culling",
                 timed_compute<Culling::kGpu>,
                 Skip::kOn,
                 {"pose", "skinning", "upload", "draw", "read_back", "decision"}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace vestige
