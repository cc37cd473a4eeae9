#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <memory>
#include <ostream>
#include <string>
#include <tuple>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/pairs/adversarial_pairs.hpp"
#include "tests/support/pairs/pile.hpp"
#include "tests/support/pairs/same_contact.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/small_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;
using test::same;

DetectorOptions options(Method method, Skip skip = Skip::kOff) {
  return {Surface::kAll, PlaneSet::all(), method, skip};
}

/// "gl" is the context of all tests.
std::unique_ptr<GlContext> context_named(const std::string& name) {
  // own context: OSMesa, beside it
  return name == "gl" ? test::make_context() : make_osmesa_context();
}

/// A detector whose shaders prove misses.
struct Prover {
  const char* name;
  decltype(make_geometry_detector)* make;
  const char* context = "gl";
  bool as_on_gpu = false;
  Culling culling = Culling::kCpu;
};
void PrintTo(const Prover& prover, std::ostream* out) {
  *out << prover.name;
}
constexpr Prover kProvers[] = {{"geometry", make_geometry_detector},
                               {"geometry_osmesa", make_geometry_detector, "osmesa"},
                               {"compute", make_compute_detector},
                               {"compute_osmesa", make_compute_detector, "osmesa"},
                               {"compute_as_on_gpu", make_compute_detector, "gl", true}};
/// These have shaders that skip, too.
constexpr Prover kCullers[] = {{"compute_culling", make_compute_detector, "gl", true, Culling::kGpu},
                               {"compute_culling_osmesa", make_compute_detector, "osmesa", true, Culling::kGpu}};
constexpr Method kMethods[] = {Method::kStatic, Method::kCarried, Method::kCcd};

class ProvingDetector : public ::testing::TestWithParam<std::tuple<Prover, Method, Skip>> {
 protected:
  std::unique_ptr<Detector> make_prover(const Avatar& avatar, const ActuatorMap& map) const {
    const Prover& prover = std::get<0>(GetParam());
    DetectorOptions chosen = options(method(), skip());
    chosen.as_on_gpu = prover.as_on_gpu;
    chosen.culling = prover.culling;
    return prover.make(context_named(prover.context), avatar, map, chosen);
  }
  Method method() const { return std::get<1>(GetParam()); }
  Skip skip() const { return std::get<2>(GetParam()); }
  Culling culling() const { return std::get<0>(GetParam()).culling; }
};

std::string name_of_prover(const ::testing::TestParamInfo<std::tuple<Prover, Method, Skip>>& test) {
  const auto& [prover, method, skip] = test.param;
  return std::string(prover.name) + "_" + name_of(method) + (skip == Skip::kOn ? "_skipping" : "");
}

INSTANTIATE_TEST_SUITE_P(Each, ProvingDetector,
                         ::testing::Combine(::testing::ValuesIn(kProvers), ::testing::ValuesIn(kMethods),
                                            ::testing::Values(Skip::kOff, Skip::kOn)),
                         name_of_prover);
INSTANTIATE_TEST_SUITE_P(Culling, ProvingDetector,
                         ::testing::Combine(::testing::ValuesIn(kCullers), ::testing::ValuesIn(kMethods),
                                            ::testing::Values(Skip::kOn)),
                         name_of_prover);

/// That shaders that prove what the CPU found did the same work as `cpu`, apart from the proofs.
void expect_same_work(const DetectorWork& work, const DetectorWork& expected) {
  EXPECT_GE(work.pairs_captured, work.pairs_meeting);
  EXPECT_EQ(work.pairs_tested, expected.pairs_tested);
  EXPECT_EQ(work.triangles_tested, expected.triangles_tested);
  EXPECT_EQ(work.meshlets_skinned, expected.meshlets_skinned);
  EXPECT_EQ(work.frames_skipped, expected.frames_skipped);
}

/// Compares the two in a scene. Returns the number of contacts.
std::uint64_t compare(Detector& prover, Detector& cpu, const std::vector<TraceFrame>& scene, Culling culling) {
  std::uint64_t contacts = 0;
  ContactRow row;
  ContactRow expected;
  const auto colliders = static_cast<std::uint32_t>(scene.front().colliders.size());
  FrameBuilder builder = test::frame_builder(builtin_avatar(), colliders, cpu.method());
  for (const TraceFrame& trace_frame : scene) {
    const DetectorFrame& frame = builder.next(trace_frame);
    const DetectorWork work = prover.detect(frame, row);
    const DetectorWork expected_work = cpu.detect(frame, expected);
    EXPECT_EQ(work.pairs_meeting, expected_work.pairs_meeting);
    if (culling == Culling::kCpu) expect_same_work(work, expected_work);
    EXPECT_EQ(row.size(), expected.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      EXPECT_TRUE(same(row[i], expected[i])) << "frame " << frame.index << ", column " << i;
      if (row[i].hit()) ++contacts;
    }
  }
  return contacts;
}

TEST_P(ProvingDetector, GivesTheBitsOfTheCpuInEveryScenario) {
  const auto prover = make_prover(builtin_avatar(), builtin_map());
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options(method(), skip()));
  for (const Scenario& scenario : scenarios()) {
    const std::uint32_t colliders = std::min(scenario.default_count, 40U);
    std::vector<TraceFrame> scene = test::scene(scenario.name, builtin_avatar(), colliders, 12, 15);
    const auto contacts_with = [&](float radius_m) {
      for (TraceFrame& frame : scene)
        for (ColliderSample& collider : frame.colliders) collider.radius_m = radius_m;
      return compare(*prover, *cpu, scene, culling());
    };
    const bool of_spheres = scenario.name == "rest" || scenario.name == "brush";  // their centres stay outside
    const bool moves = scenario.name != "still" || method() != Method::kStatic;   // a point rarely rests on the skin
    EXPECT_EQ(contacts_with(0) > 0, moves && !of_spheres) << scenario.name;
    EXPECT_GT(contacts_with(of_spheres ? 0.05F : 0.03F), 0U) << scenario.name;
  }
}

/// Each collider goes to and fro through a place at the skin.
TEST_P(ProvingDetector, GivesTheBitsOfTheCpuWhereWaysAreLong) {
  if (skip() == Skip::kOff) return;  // that cuts no way
  const auto prover = make_prover(builtin_avatar(), builtin_map());
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options(method(), skip()));
  for (const double length_m : {10.0, 1e4, 1e8}) {
    std::vector<TraceFrame> scene = test::scene("hug", builtin_avatar(), 20, 5, 1000);
    for (std::size_t i = 0; i < scene.size(); ++i)
      for (ColliderSample& collider : scene[i].colliders)
        collider.position_m += (i % 2 == 0 ? length_m : -length_m) * glm::dvec3(1, 0.5, 1.0 / (1 + collider.id));
    EXPECT_GT(compare(*prover, *cpu, scene, culling()), 10U) << length_m;
  }
}

/// The proof itself: a pair that meets and was not captured would be missing in the count.
TEST_P(ProvingDetector, CapturesEveryPairThatMeetsHoweverItWasAimed) {
  constexpr std::size_t kTriangles = 20;
  constexpr std::size_t kSegments = 60;
  const Avatar avatar = loose_triangles(kTriangles);
  const ActuatorMap map;
  const auto prover = make_prover(avatar, map);
  const auto cpu = make_cpu_detector(avatar, map, options(method()));
  test::AdversarialSource points(1);
  test::AdversarialSource spheres(1, ColliderShape::kSpheres);
  ContactRow row;
  ContactRow expected;
  std::uint64_t meeting = 0;
  std::uint64_t captured = 0;
  for (int draw = 0; draw < 60; ++draw) {
    const test::AdversarialPairs pairs = (draw % 3 == 0 ? spheres : points).draw(kTriangles, kSegments);
    const DetectorFrame frame = loose_frame(pairs.before, pairs.now, pairs.segments);
    const DetectorWork work = prover->detect(frame, row);
    const DetectorWork expected_work = cpu->detect(frame, expected);
    ASSERT_EQ(work.pairs_meeting, expected_work.pairs_meeting) << "draw " << draw;
    for (std::size_t i = 0; i < row.size(); ++i) ASSERT_TRUE(same(row[i], expected[i])) << draw << ", " << i;
    meeting += work.pairs_meeting;
    captured += work.pairs_captured;
  }
  constexpr std::uint64_t kPairs = 60 * kTriangles * kSegments;
  EXPECT_GT(meeting, kPairs / 10);
  EXPECT_LT(captured, kPairs);  // it does prove something, even here
}

TEST_P(ProvingDetector, LosesNoPairWhereFarMoreMeetThanThereWasRoomFor) {
  const Avatar avatar = test::pile_of(50);
  const ActuatorMap map;
  const auto prover = make_prover(avatar, map);
  const DetectorFrame frame = test::frame_through(avatar, 100);
  ContactRow row;
  for (int i = 0; i < 2; ++i) {  // growing, and grown
    const DetectorWork work = prover->detect(frame, row);
    EXPECT_EQ(work.pairs_captured, 50U * 100U);
    EXPECT_EQ(work.pairs_meeting, 50U * 100U);
    for (const Contact& contact : row) ASSERT_EQ(contact.triangle, 49U);
  }
}

/// More meshlets, and more segments at one of them, than one draw of `skip` takes; the last meshlet is not full.
TEST_P(ProvingDetector, FindsAllPairsWhereMeshletsAndSegmentsAreMany) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < 9000; ++i) {
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
      vertices.emplace_back(corner.x + 2 * static_cast<float>(i), corner.y, 0);
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  const Avatar avatar = test::rigid_avatar(vertices, triangles);
  const ActuatorMap map;
  const auto prover = make_prover(avatar, map);
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    // Almost all meshlets, each met about once; then the last, met by 700 more.
    const float x = i < 300 ? 60.0F * static_cast<float>(i) : 17998.0F;
    segments.push_back({i, {x + 0.25F, 0.25F, 1}, {x + 0.25F, 0.25F, -1}});
  }
  DetectorFrame frame = test::frame_of(avatar, segments);
  frame.palette_before = frame.palette;
  ContactRow row;
  const DetectorWork work = prover->detect(frame, row);
  EXPECT_EQ(work.pairs_captured, 1000U);
  EXPECT_EQ(work.pairs_meeting, 1000U);
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(row[i].triangle, i < 300 ? 30 * i : 8999U) << i;
}

TEST_P(ProvingDetector, CapturesWhatItCannotComputeWith) {
  const float huge = std::ldexp(1.0F, 100);
  const std::vector<LooseTriangle> triangles = {{glm::vec3(-huge, -huge, 0), {huge, -huge, 0}, {0, huge, 0}}};
  const Avatar avatar = loose_triangles(1);
  const ActuatorMap map;
  const auto prover = make_prover(avatar, map);
  ContactRow row;
  prover->detect(loose_frame(triangles, triangles, {{0, {0, 0, -huge}, {0, 0, 3 * huge}}}), row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_EQ(row[0].t, 0.25F);
  // A triangle that it can compute with, a segment that it cannot.
  const std::vector<LooseTriangle> small = {{glm::vec3(-1, -1, 0), {1, -1, 0}, {0, 1, 0}}};
  prover->detect(loose_frame(small, small, {{0, {0, 0, -huge}, {0, 0, 3 * huge}}}), row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_EQ(row[0].t, 0.25F);
}

TEST_P(ProvingDetector, SkipsAFrameWhoseCollidersAreFarAway) {
  const auto prover = make_prover(builtin_avatar(), builtin_map());
  DetectorFrame frame = test::frame_of(builtin_avatar(), {{0, {9, 9, 9}, {9, 9, 8}}});
  frame.palette_before = frame.palette;
  ContactRow row = {Contact()};
  row[0].triangle = 7;
  const DetectorWork work = prover->detect(frame, row);
  EXPECT_FALSE(row[0].hit());
  EXPECT_EQ(work.frames_skipped, skip() == Skip::kOn ? 1U : 0U);
  EXPECT_EQ(work.pairs_tested, skip() == Skip::kOn ? 0U : builtin_avatar().triangles.size());
}

/// At most 1 % more than what meets, at the rate that traces are recorded with.
TEST(GeometryDetectorAtRecordingRate, CapturesHardlyMoreThanWhatMeets) {
  for (const Skip skip : {Skip::kOff, Skip::kOn}) {
    DetectorOptions each = options(Method::kStatic);
    each.skip = skip;
    const auto geometry = make_geometry_detector(test::make_context(), builtin_avatar(), builtin_map(), each);
    DetectorWork work;
    ContactRow row;
    FrameBuilder builder = test::frame_builder(builtin_avatar(), 100, Method::kStatic);
    for (const TraceFrame& frame : test::scene("hug", builtin_avatar(), 100, 200, 1000))
      work += geometry->detect(builder.next(frame), row);
    EXPECT_GT(work.pairs_meeting, 100U);
    EXPECT_LE(work.pairs_captured - work.pairs_meeting, 2 + work.pairs_meeting / 100);
  }
}

/// The bound of shaders/geometry.vert, computed anew in double. The shader's own vertices must lie within it.
std::vector<glm::dvec3> skinning_radius(const Avatar& avatar, const DetectorFrame& frame) {
  std::vector<glm::dvec3> radius;
  radius.reserve(avatar.position_bind.size());
  for (std::size_t i = 0; i < avatar.position_bind.size(); ++i) {
    const glm::dvec3 bind(avatar.position_bind[i]);
    std::array<glm::dvec3, 4> blend = {};
    std::array<glm::dvec3, 4> size = {};
    double roundings = 0;
    for (std::size_t k = 0; k < avatar.influence_count; ++k) {
      const double weight = static_cast<double>(avatar.influences[i].weight[k]);
      if (weight != 0) ++roundings;
      for (std::size_t c = 0; c < 4; ++c) {
        const glm::dvec3 column(frame.palette[avatar.influences[i].palette[k]].column[c]);
        blend[c] += weight * column;
        size[c] += weight * glm::abs(column);
      }
    }
    if (roundings == 1 && avatar.influences[i].weight[0] == 1) roundings = 0;
    const glm::dvec3 products = size[0] * std::abs(bind.x) + size[1] * std::abs(bind.y) + size[2] * std::abs(bind.z);
    const glm::dvec3 sum_1 = blend[0] * bind.x + blend[1] * bind.y;
    const glm::dvec3 sum_2 = sum_1 + blend[2] * bind.z;
    radius.push_back(std::ldexp(1.001, -23) * (roundings * (products + size[3]) + products + glm::abs(sum_1) +
                                               glm::abs(sum_2) + glm::abs(sum_2 + blend[3])));
  }
  return radius;
}

/// The vertices of a triangle at z = 1, skinned by two joints, may be off by 5 * 2^-23: a miss by less is for the CPU
/// to see, a clear miss is proven.
TEST(GeometryDetectorSkinning, LeavesMissesWithinItsBoundToTheCpuAndProvesThoseBeyond) {
  Avatar avatar = test::rigid_avatar({{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}}, {{0, 1, 2}});
  avatar.palette.resize(2);
  avatar.influence_count = 2;
  for (Influences& influences : avatar.influences) influences = {{0, 1}, {0.5F, 0.5F}};
  const DetectorFrame still = test::frame_of(avatar, {});
  ASSERT_NEAR(skinning_radius(avatar, still)[0].z, std::ldexp(5.0, -23), std::ldexp(1.0, -30));
  for (const char* context : {"gl", "osmesa"}) {
    const ActuatorMap map;
    const auto geometry = make_geometry_detector(context_named(context), avatar, map, options(Method::kStatic));
    const auto captured = [&](float end) {
      ContactRow row;
      const DetectorWork work = geometry->detect(test::frame_of(avatar, {{0, {0, 0, 1.5F}, {0, 0, end}}}), row);
      EXPECT_EQ(row[0].hit(), end <= 1) << end;
      EXPECT_EQ(work.pairs_meeting, end <= 1 ? 1U : 0U);
      return work.pairs_captured;
    };
    EXPECT_EQ(captured(1), 1U) << context;
    EXPECT_EQ(captured(1 + std::ldexp(4.0F, -23)), 1U) << context;
    EXPECT_EQ(captured(1 + std::ldexp(7.0F, -23)), 0U) << context;
  }
}

/// A slanted segment of 2.8 km passes an edge of the triangle, whose vertices hardly err at all. Its ends round to
/// 2^-14 m: so much and a little more is for the CPU to see.
TEST(GeometryDetectorSkinning, LeavesMissesWithinItsOwnRoundingToTheCpu) {
  const Avatar avatar = test::rigid_avatar({{0, -1, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}});
  const ActuatorMap map;
  const auto geometry = make_geometry_detector(test::make_context(), avatar, map, options(Method::kStatic));
  const auto captured = [&](float aside) {
    ContactRow row;
    const DetectorFrame frame = test::frame_of(avatar, {{0, {-1000 - aside, 0, -1000}, {1000 - aside, 0, 1000}}});
    const DetectorWork work = geometry->detect(frame, row);
    EXPECT_EQ(row[0].hit(), aside == 0) << aside;
    return work.pairs_captured;
  };
  EXPECT_EQ(captured(0), 1U);
  EXPECT_EQ(captured(std::ldexp(1.0F, -14)), 1U);
  EXPECT_EQ(captured(std::ldexp(4.0F, -14)), 1U);
  EXPECT_EQ(captured(std::ldexp(64.0F, -14)), 0U);
}

TEST(GeometryDetectorSkinning, LiesWithinItsBoundOfTheCpusAndTheBoundIsMicrometres) {
  std::vector<std::pair<std::string, Avatar>> avatars = {{"builtin", builtin_avatar()}};
  VESTIGE_REQUIRE_DATA(test::data("avatars/avatars"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::data("avatars/avatars")))
    if (entry.path().extension() == ".glb")
      avatars.emplace_back(entry.path().string(),
                           parse_avatar_glb(read_avatar_glb(entry.path()), entry.path().string()));
  for (const auto& named : avatars) {
    const Avatar& avatar = named.second;
    const auto geometry = make_geometry_detector(test::make_context(), avatar, builtin_map(), options(Method::kStatic));
    std::vector<glm::vec3> vertices;
    std::vector<glm::vec3> expected;
    double largest = 0;
    glm::dvec3 extent(0);
    FrameBuilder builder = test::frame_builder(avatar, 1, Method::kStatic);
    for (const TraceFrame& trace_frame : test::scene("swarm", avatar, 1, 5, 3)) {
      const DetectorFrame& frame = builder.next(trace_frame);
      geometry->skinned_vertices(frame, vertices);
      skin_vertices(avatar, frame.palette, expected);
      const std::vector<glm::dvec3> radius = skinning_radius(avatar, frame);
      for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const double error =
              std::abs(static_cast<double>(vertices[i][axis]) - static_cast<double>(expected[i][axis]));
          ASSERT_LE(error, radius[i][axis]) << named.first << ", vertex " << i;
          largest = std::max(largest, radius[i][axis]);
          extent[axis] = std::max(extent[axis], std::abs(static_cast<double>(expected[i][axis])));
        }
    }
    EXPECT_LT(largest, 4e-6 * std::max({extent.x, extent.y, extent.z})) << named.first;
  }
}

}  // namespace
}  // namespace vestige
