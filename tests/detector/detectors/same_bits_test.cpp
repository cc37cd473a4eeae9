// One texture hash for every detector that keeps the contract, wherever the scene stands.

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/scenario_names.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

using Question = std::tuple<std::string_view, Method>;

std::unique_ptr<Detector> make_compute_that_culls(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                  const ActuatorMap& map, const DetectorOptions& options) {
  DetectorOptions culling = options;
  culling.culling = Culling::kGpu;
  return make_compute_detector(std::move(context), avatar, map, culling);
}

/// The detectors with shaders. That which culls differs from `compute` only if it skips.
std::vector<decltype(&make_compute_detector)> makers_with_shaders(Skip skip) {
  std::vector<decltype(&make_compute_detector)> makers = {make_geometry_detector, make_compute_detector};
  if (skip == Skip::kOn) makers.push_back(make_compute_that_culls);
  return makers;
}

class SameBits : public ::testing::TestWithParam<Question> {};

TEST_P(SameBits, ComeFromTheCpuAndFromTheSlowTruthHereAndTenThousandKilometresAway) {
  const auto [scenario, method] = GetParam();
  constexpr int kFrames = 10;
  constexpr double kRate_hz = 5;
  const std::uint32_t colliders = find_scenario(scenario)->default_count;
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, method};
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options);
  const auto exact = make_exact_detector(builtin_avatar(), builtin_map(), options);

  const auto here = test::scene(scenario, builtin_avatar(), colliders, kFrames, kRate_hz);
  const auto there = test::scene(scenario, builtin_avatar(), colliders, kFrames, kRate_hz, {1e7, 0, 0});
  const test::SceneRun truth = test::run_scene(here, builtin_avatar(), colliders, *exact);
  EXPECT_EQ(truth.contacts() > 0, scenario != "still" || method != Method::kStatic);
  EXPECT_EQ(hash_of(test::run_scene(here, builtin_avatar(), colliders, *cpu)), hash_of(truth));
  EXPECT_EQ(hash_of(test::run_scene(there, builtin_avatar(), colliders, *cpu)), hash_of(truth));
}

TEST_P(SameBits, ComeFromShadersInEveryContextSkippingOrNot) {
  const auto [scenario, method] = GetParam();
  const std::uint32_t colliders = find_scenario(scenario)->default_count;
  const auto scene = test::scene(scenario, builtin_avatar(), colliders, 10, 20);
  DetectorOptions options = {Surface::kAll, kHashedPlanes, method};
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options);
  const std::string expected = hash_of(test::run_scene(scene, builtin_avatar(), colliders, *cpu));
  // own context: OSMesa, beside the one of all tests
  for (const auto make_context : {test::make_context, make_osmesa_context}) {
    for (const Skip skip : {Skip::kOff, Skip::kOn}) {
      options.skip = skip;
      for (const auto make : makers_with_shaders(skip)) {
        const auto detector = make(make_context(), builtin_avatar(), builtin_map(), options);
        EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), colliders, *detector)), expected)
            << detector->name() << ", " << detector->gl_info().context << (skip == Skip::kOn ? ", skipping" : "");
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, SameBits,
                         ::testing::Combine(::testing::ValuesIn(test::scenario_names()),
                                            ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" + name_of(std::get<1>(test.param));
                         });

TEST(MappedSurface, GivesTheSameBitsFromTheCpuAndFromTheSlowTruth) {
  const auto scene = test::scene("swarm", builtin_avatar(), 100, 8, 20);
  const DetectorOptions options = {Surface::kMapped, kHashedPlanes, Method::kCcd};
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options);
  const auto exact = make_exact_detector(builtin_avatar(), builtin_map(), options);
  const test::SceneRun truth = test::run_scene(scene, builtin_avatar(), 100, *exact);
  EXPECT_GT(truth.contacts(), 10U);
  EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), 100, *cpu)), hash_of(truth));
  for (const Skip skip : {Skip::kOff, Skip::kOn}) {
    for (const auto make : makers_with_shaders(skip)) {
      const auto detector = make(test::make_context(), builtin_avatar(), builtin_map(),
                                 {Surface::kMapped, kHashedPlanes, Method::kCcd, skip});
      EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), 100, *detector)), hash_of(truth)) << detector->name();
    }
  }
}

}  // namespace
}  // namespace vestige
