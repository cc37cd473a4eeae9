// What poses and colliders that nobody would send bring about: numbers that are none fire nothing and are reported with
// their frame; whatever is finite is decided as ever, exactly, and to the same bits by `cpu`, `geometry`, skipping or
// not, and `exact`.

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/output/texture_hash.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kColliders = 12;
constexpr std::size_t kHostileFrames = 8;
constexpr std::size_t kHostileFrame = 4;

const ActuatorMap& no_map() {
  static const ActuatorMap map;
  return map;
}

/// Colliders that go through the walking avatar in every frame.
std::vector<TraceFrame> calm_scene() {
  return test::scene("hug", builtin_avatar(), kColliders, static_cast<int>(kHostileFrames), 5);
}

std::unique_ptr<Detector> make_geometry(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_geometry_detector(test::make_context(), avatar, map, options);
}

std::unique_ptr<Detector> make_compute(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_compute_detector(test::make_context(), avatar, map, options);
}

std::unique_ptr<Detector> make_culling(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  DetectorOptions culling = options;
  culling.culling = Culling::kGpu;
  return make_compute(avatar, map, culling);
}

template <decltype(make_cpu_detector)* kMake>
std::unique_ptr<Detector> make_skipping(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  DetectorOptions skipping = options;
  skipping.skip = Skip::kOn;
  return kMake(avatar, map, skipping);
}
constexpr auto make_skipping_cpu_detector = make_skipping<make_cpu_detector>;
constexpr auto make_skipping_geometry = make_skipping<make_geometry>;
constexpr auto make_skipping_compute = make_skipping<make_compute>;
constexpr auto make_culling_compute = make_skipping<make_culling>;

test::SceneRun run(const std::vector<TraceFrame>& scene, Method method, decltype(make_cpu_detector)* make) {
  const auto detector = make(builtin_avatar(), no_map(), {Surface::kAll, kHashedPlanes, method});
  return test::run_scene(scene, builtin_avatar(), kColliders, *detector);
}

std::string hash_of(const ContactRow& row) {
  TextureHash hash;
  hash.add(row);
  return hash.hex();
}

struct Hostility {
  const char* name;
  std::function<void(TraceFrame&)> change;  ///< of frame kHostileFrame
};

void PrintTo(const Hostility& hostility, std::ostream* out) {  // NOLINT(readability-identifier-naming): GoogleTest's
  *out << hostility.name;
}

NodeLocal& root_of(TraceFrame& frame) {
  return frame.poses.front().nodes[static_cast<std::size_t>(builtin_avatar().root_node)];
}
NodeLocal& some_joint_of(TraceFrame& frame) {
  return frame.poses.front().nodes[frame.poses.front().nodes.size() / 2];
}

using Case = std::tuple<Hostility, Method>;
std::string name_of_case(const ::testing::TestParamInfo<Case>& test) {
  return std::string(std::get<0>(test.param).name) + "_" + name_of(std::get<1>(test.param));
}
const auto kEveryMethod = ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd);

/// Whether `method` looks at the frame before, which a hostile frame is to the next.
bool looks_back(Method method) {
  return method != Method::kStatic;
}

/// That every detector finds the `expected` contacts of each frame, and reports the hostile one first; `check` looks at
/// what else it reports.
template <typename Check>
void expect_everywhere(const std::vector<TraceFrame>& scene, Method method, const std::vector<ContactRow>& expected,
                       Check&& check) {
  for (const auto make : {make_cpu_detector, make_skipping_cpu_detector, make_geometry, make_skipping_geometry,
                          make_skipping_compute, make_culling_compute, make_exact_detector}) {
    const test::SceneRun found = run(scene, method, make);
    check(found);
    EXPECT_EQ(found.first_non_finite, kHostileFrame);
    for (std::size_t frame = 0; frame < kHostileFrames; ++frame)
      EXPECT_EQ(hash_of(found.rows[frame]), hash_of(expected[frame])) << frame;
  }
}

class PoseThatIsNotFinite : public ::testing::TestWithParam<Case> {};

TEST_P(PoseThatIsNotFinite, FiresNothingIsReportedWithItsFrameAndLeavesTheOthersAlone) {
  const auto& [hostility, method] = GetParam();
  std::vector<TraceFrame> hostile = calm_scene();
  const test::SceneRun calm = run(hostile, method, make_cpu_detector);
  hostility.change(hostile[kHostileFrame]);
  std::vector<ContactRow> expected = calm.rows;
  expected[kHostileFrame] = ContactRow(kColliders);
  if (looks_back(method)) expected[kHostileFrame + 1] = ContactRow(kColliders);
  expect_everywhere(hostile, method, expected,
                    [](const test::SceneRun& found) { EXPECT_EQ(found.non_finite_frames, 1U); });
  EXPECT_GT(calm.contacts_in(kHostileFrame), 0U);
  EXPECT_GT(calm.contacts_in(kHostileFrame + 1), 0U);
}

const Hostility kNotFinitePoses[] = {
    {"nan_translation", [](TraceFrame& frame) { root_of(frame).translation.y = kNan; }},
    {"infinite_translation", [](TraceFrame& frame) { some_joint_of(frame).translation.x = kInfinity; }},
    {"nan_rotation", [](TraceFrame& frame) { some_joint_of(frame).rotation.w = kNan; }},
    {"infinite_rotation", [](TraceFrame& frame) { root_of(frame).rotation.x = -kInfinity; }},
    {"infinite_scale", [](TraceFrame& frame) { root_of(frame).scale.z = kInfinity; }},
    {"overflowing_scale", [](TraceFrame& frame) { root_of(frame).scale = glm::vec3(3e38F); }},
    {"overflowing_product",
     [](TraceFrame& frame) {
       for (NodeLocal& node : frame.poses.front().nodes) node.scale = glm::vec3(1e20F);
     }},
    {"nan_origin", [](TraceFrame& frame) { frame.poses.front().origin_m.z = static_cast<double>(kNan); }},
    {"infinite_origin", [](TraceFrame& frame) { frame.poses.front().origin_m.x = static_cast<double>(kInfinity); }},
};
INSTANTIATE_TEST_SUITE_P(Each, PoseThatIsNotFinite,
                         ::testing::Combine(::testing::ValuesIn(kNotFinitePoses), kEveryMethod), name_of_case);

class ColliderThatIsNotFinite : public ::testing::TestWithParam<Case> {};

TEST_P(ColliderThatIsNotFinite, FiresNothingIsReportedWithItsFrameAndLeavesTheOthersAlone) {
  const auto& [hostility, method] = GetParam();
  std::vector<TraceFrame> hostile = calm_scene();
  const test::SceneRun calm = run(hostile, method, make_cpu_detector);
  hostility.change(hostile[kHostileFrame]);
  std::vector<ContactRow> expected = calm.rows;
  for (const std::size_t frame : {kHostileFrame, kHostileFrame + 1}) expected[frame][0] = Contact();
  expect_everywhere(hostile, method, expected, [](const test::SceneRun& found) {
    EXPECT_EQ(found.non_finite_frames, 0U);
    EXPECT_EQ(found.non_finite_segments, 2U);  // there and away again
  });
}

void put_first_collider(TraceFrame& frame, double x) {
  for (ColliderSample& collider : frame.colliders)
    if (collider.id == 0) collider.position_m.x = x;
}

const Hostility kNotFiniteColliders[] = {
    {"nan", [](TraceFrame& frame) { put_first_collider(frame, static_cast<double>(kNan)); }},
    {"infinite", [](TraceFrame& frame) { put_first_collider(frame, -static_cast<double>(kInfinity)); }},
    {"beyond_fp32", [](TraceFrame& frame) { put_first_collider(frame, 1e39); }},
    {"almost_beyond_fp32", [](TraceFrame& frame) { put_first_collider(frame, 3.4e38); }},
};
INSTANTIATE_TEST_SUITE_P(Each, ColliderThatIsNotFinite,
                         ::testing::Combine(::testing::ValuesIn(kNotFiniteColliders), kEveryMethod), name_of_case);

class FinitePose : public ::testing::TestWithParam<Case> {};

TEST_P(FinitePose, HoweverStrangeIsDecidedToTheSameBitsAsTheTruth) {
  const auto& [hostility, method] = GetParam();
  std::vector<TraceFrame> hostile = calm_scene();
  const test::SceneRun calm = run(hostile, method, make_cpu_detector);
  hostility.change(hostile[kHostileFrame]);
  const test::SceneRun found = run(hostile, method, make_cpu_detector);
  const test::SceneRun skipping = run(hostile, method, make_skipping_cpu_detector);
  const test::SceneRun drawn = run(hostile, method, make_geometry);
  const test::SceneRun drawn_skipping = run(hostile, method, make_skipping_geometry);
  const test::SceneRun computed = run(hostile, method, make_skipping_compute);
  const test::SceneRun culled = run(hostile, method, make_culling_compute);
  const test::SceneRun truth = run(hostile, method, make_exact_detector);
  EXPECT_FALSE(found.first_non_finite);
  for (std::size_t frame = 0; frame < kHostileFrames; ++frame) {
    EXPECT_EQ(hash_of(found.rows[frame]), hash_of(truth.rows[frame])) << frame;
    EXPECT_EQ(hash_of(skipping.rows[frame]), hash_of(truth.rows[frame])) << frame;
    EXPECT_EQ(hash_of(drawn.rows[frame]), hash_of(truth.rows[frame])) << frame;
    EXPECT_EQ(hash_of(drawn_skipping.rows[frame]), hash_of(truth.rows[frame])) << frame;
    EXPECT_EQ(hash_of(computed.rows[frame]), hash_of(truth.rows[frame])) << frame;
    EXPECT_EQ(hash_of(culled.rows[frame]), hash_of(truth.rows[frame])) << frame;
    if (frame == kHostileFrame || frame == kHostileFrame + 1) continue;
    EXPECT_EQ(hash_of(found.rows[frame]), hash_of(calm.rows[frame])) << frame;
  }
}

const Hostility kFinitePoses[] = {
    {"collapsed_avatar", [](TraceFrame& frame) { root_of(frame).scale = glm::vec3(0); }},
    {"flattened_avatar", [](TraceFrame& frame) { root_of(frame).scale.z = 0; }},
    {"collapsed_bone", [](TraceFrame& frame) { some_joint_of(frame).scale = glm::vec3(0); }},
    {"mirrored_avatar", [](TraceFrame& frame) { root_of(frame).scale.x *= -1; }},
    {"mirrored_bone", [](TraceFrame& frame) { some_joint_of(frame).scale *= -1.0F; }},
    {"denormal_scale", [](TraceFrame& frame) { root_of(frame).scale *= 1e-41F; }},
    {"tiny_scale", [](TraceFrame& frame) { root_of(frame).scale *= 1e-20F; }},
    {"large_scale", [](TraceFrame& frame) { root_of(frame).scale *= 1e12F; }},
    {"larger_scale", [](TraceFrame& frame) { root_of(frame).scale *= 3e12F; }},
    {"huge_scale", [](TraceFrame& frame) { root_of(frame).scale *= 1e15F; }},
    {"denormal_translation", [](TraceFrame& frame) { some_joint_of(frame).translation *= 1e-43F; }},
    {"no_rotation", [](TraceFrame& frame) { some_joint_of(frame).rotation = glm::quat(0, 0, 0, 0); }},
    {"twisted_bone", [](TraceFrame& frame) { some_joint_of(frame).rotation = glm::quat(0, 0, 1, 0); }},
    {"turned_head_over_heels", [](TraceFrame& frame) { root_of(frame).rotation = glm::quat(0, 1, 0, 0); }},
    {"teleport_within_reach", [](TraceFrame& frame) { frame.poses.front().origin_m.x += 1.5; }},
    {"teleport_of_a_kilometre", [](TraceFrame& frame) { frame.poses.front().origin_m.z += 1000.3; }},
    {"teleport_around_the_earth", [](TraceFrame& frame) { frame.poses.front().origin_m.y -= 4e7; }},
    {"denormal_collider", [](TraceFrame& frame) { put_first_collider(frame, 4e-310); }},
    {"far_collider", [](TraceFrame& frame) { put_first_collider(frame, 1e25); }},
    {"farthest_collider_and_hugest_scale",
     [](TraceFrame& frame) {
       put_first_collider(frame, 1.7e38);
       root_of(frame).scale *= 1e37F;
     }},
};
INSTANTIATE_TEST_SUITE_P(Each, FinitePose, ::testing::Combine(::testing::ValuesIn(kFinitePoses), kEveryMethod),
                         name_of_case);

/// One triangle in the plane z = 0, its node scaled in the second of two frames; a collider falls through it.
class ScaledTriangle : public ::testing::TestWithParam<Method> {
 protected:
  Contact contact_at(const glm::vec3& scale, const glm::dvec3& from, const glm::dvec3& to) const {
    const Avatar avatar = test::rigid_avatar({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
    std::vector<TraceFrame> scene(2);
    for (std::size_t k = 0; k < scene.size(); ++k) {
      scene[k].index = k;
      scene[k].time_ns = static_cast<std::int64_t>(k) * 10'000'000;
      scene[k].poses.front() = rest_pose(avatar);
      scene[k].poses.front().nodes[0].scale = scale;
      scene[k].colliders = {{0, k == 0 ? from : to}};
    }
    const auto cpu = make_cpu_detector(avatar, no_map(), {Surface::kAll, PlaneSet::all(), GetParam()});
    return test::run_scene(scene, avatar, 1, *cpu).rows[1][0];
  }
};

TEST_P(ScaledTriangle, WithoutHeightIsTheLineThatItsCornersSpan) {
  const Contact on_line = contact_at({1, 0, 1}, {0.5, 0, 1}, {0.5, 0, -3});
  EXPECT_TRUE(on_line.hit());
  EXPECT_EQ(on_line.t, 0.25F);
  EXPECT_EQ(on_line.side, 0);
  EXPECT_FALSE(contact_at({1, 0, 1}, {0.5, 1e-6, 1}, {0.5, 1e-6, -3}).hit());
}

TEST_P(ScaledTriangle, WithoutAnySizeIsAPoint) {
  EXPECT_EQ(contact_at({0, 0, 0}, {0, 0, 1}, {0, 0, -1}).t, 0.5F);
  EXPECT_FALSE(contact_at({0, 0, 0}, {1e-30, 0, 1}, {1e-30, 0, -1}).hit());
}

TEST_P(ScaledTriangle, ThatIsMirroredShowsItsBack) {
  EXPECT_EQ(contact_at({1, 1, 1}, {0.25, 0, 1}, {0.25, 0, -1}).side, 1);
  EXPECT_EQ(contact_at({-1, 1, 1}, {0.25, 0, 1}, {0.25, 0, -1}).side, -1);
}

/// The start is carried so far that the slabs' fp32 overflows where their margin alone would not.
TEST(FarCarriedTriangle, IsNotSkipped) {
  constexpr float kSize_m = 3.5e12F;
  const Avatar avatar = test::rigid_avatar({{1, -1, -1}, {1, 1, -1}, {1, 0, 1}}, {{0, 1, 2}});
  std::vector<TraceFrame> scene(2);
  for (std::size_t k = 0; k < scene.size(); ++k) {
    scene[k].index = k;
    scene[k].time_ns = static_cast<std::int64_t>(k) * 10'000'000;
    scene[k].poses.front() = rest_pose(avatar);
    scene[k].poses.front().nodes[0].scale = glm::vec3(k == 0 ? -kSize_m : kSize_m, kSize_m, kSize_m);
    scene[k].colliders = {{0, glm::dvec3(k == 0 ? -1.5 : 1.5, 0, 0) * static_cast<double>(kSize_m)}};
  }
  for (const Skip skip : {Skip::kOff, Skip::kOn}) {
    const auto cpu = make_cpu_detector(avatar, no_map(), {Surface::kAll, PlaneSet::all(), Method::kCarried, skip});
    const Contact contact = test::run_scene(scene, avatar, 1, *cpu).rows[1][0];
    EXPECT_TRUE(contact.hit());
    EXPECT_EQ(contact.t, 0.5F);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ScaledTriangle, kEveryMethod, [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace vestige
