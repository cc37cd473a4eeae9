// What was proven a moment ago changes no bit, however people and colliders move.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/coherence/part_motion.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/skinning.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/long.hpp"
#include "tests/support/random_rig.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/test_data.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

constexpr std::uint32_t kColliders = 24;

/// Frames in which everything may happen: speeds from 0 to absurd, stops, reversals, teleports, jumps of the origin,
/// gaps, colliders that are absent, that graze the skin, or that are spheres, and poses that are not finite. Mostly few
/// colliders are near and they are slow, since a search that always finds much forgets what it knew.
class WildScene {
 public:
  WildScene(const Avatar& avatar, std::uint64_t seed) : avatar_(avatar), random_(seed), places_(kColliders) {
    for (Place& place : places_) place.at_m = near_skin();
  }

  const TraceFrame& next() {
    if (frames_++ % 256 == 0) is_calm_ = !one_in(5);
    if (one_in(60)) speed_ = pick({0.0, 0.0, 1e-6, 1e-4, 1e-3, 1e-3, 1e-2, 0.3}) * (one_in(2) ? 1 : -1);
    time_s_ += speed_;
    frame_.index += one_in(400) ? 3U : 1U;
    frame_.time_ns += 1'000'000;
    if (one_in(150)) origin_m_ += glm::dvec3(pick({0.0, 0.01, 1.0, 1.7, 300.0}), 0, pick({0.0, -2.5}));
    Pose& pose = frame_.poses.front();
    pose = sample_animation(avatar_, avatar_.animations[animation_], std::fmod(std::abs(time_s_), 2.0));
    if (one_in(300)) animation_ = random_() % avatar_.animations.size();
    pose.origin_m += origin_m_;
    if (one_in(500)) pose.nodes[3].translation.x = std::numeric_limits<float>::quiet_NaN();
    frame_.colliders.clear();
    frame_.teleported.clear();
    for (std::uint32_t id = 0; id < kColliders; ++id) move(id);
    return frame_;
  }

 private:
  struct Place {
    glm::dvec3 at_m = glm::dvec3(0);
    glm::dvec3 way_m = glm::dvec3(0);
    float radius_m = 0;
  };

  void move(std::uint32_t id) {
    Place& place = places_[id];
    if (one_in(80))
      place.way_m = direction() * (is_calm_ ? pick({0.0, 1e-7, 1e-5, 1e-4, 3e-4, 1e-3})
                                            : pick({0.0, 0.0, 1e-7, 1e-5, 1e-4, 3e-4, 3e-3, 3e-3, 0.02, 5.0}));
    if (one_in(80)) place.way_m = -place.way_m;
    if (one_in(200)) place.radius_m = static_cast<float>(pick({0.0, 0.0, 0.0, 1e-3, 0.02, is_calm_ ? 0.01 : 0.1}));
    if (one_in(150)) {
      place.at_m = near_skin();
      if (one_in(2)) frame_.teleported.push_back(id);
    }
    place.at_m += place.way_m;
    if (glm::length(place.at_m) > 5) place.at_m = near_skin();
    if (one_in(250)) return;  // absent
    frame_.colliders.push_back({id, place.at_m + origin_m_, place.radius_m});
  }

  /// On a vertex of the skin at rest, or beside it.
  glm::dvec3 near_skin() {
    const glm::vec3& vertex = avatar_.position_bind[random_() % avatar_.position_bind.size()];
    return glm::dvec3(vertex) +
           direction() * (is_calm_ ? pick({1e-3, 0.1, 0.3, 0.3, 0.5}) : pick({0.0, 1e-6, 1e-3, 0.02, 0.5}));
  }

  bool one_in(std::uint64_t count) { return random_() % count == 0; }
  double pick(std::initializer_list<double> values) { return *(values.begin() + random_() % values.size()); }
  glm::dvec3 direction() {
    std::uniform_real_distribution<double> number(-1, 1);
    const double x = number(random_);
    const double y = number(random_);
    const glm::dvec3 v(x, y, number(random_));
    return v / std::max(glm::length(v), 1e-3);
  }

  const Avatar& avatar_;
  std::mt19937_64 random_;
  std::vector<Place> places_;
  TraceFrame frame_;
  std::uint64_t frames_ = 0;
  bool is_calm_ = true;
  double time_s_ = 0;
  double speed_ = 1e-3;
  glm::dvec3 origin_m_ = glm::dvec3(0);
  std::size_t animation_ = 0;
};

/// Calls visit(frame, row of a detector that remembers, row of one that does not) for each frame.
template <typename Visit>
DetectorWork compare(const Avatar& avatar, Method method, std::uint64_t seed, int frames, Visit&& visit) {
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, method, Skip::kOn};
  const auto remembers = make_cpu_detector(avatar, builtin_map(), options);
  const auto forgets = make_cpu_detector(avatar, builtin_map(), options);
  FrameBuilder builder = test::frame_builder(avatar, kColliders, method);
  WildScene scene(avatar, seed);
  ContactRow row;
  ContactRow expected;
  DetectorWork work;
  for (int k = 0; k < frames; ++k) {
    DetectorFrame frame = builder.next(scene.next());
    work += remembers->detect(frame, row);
    frame.index = 0;  // follows no other
    forgets->detect(frame, expected);
    visit(frame, std::as_const(row), std::as_const(expected));
  }
  return work;
}

class Coherence : public ::testing::TestWithParam<Method> {};

TEST_P(Coherence, ChangesNoBitHoweverWildTheScene) {
  const int frames = test::is_long() ? 350'000 : 2'500;
  int wrong = 0;
  std::uint64_t contacts = 0;
  int k = 0;
  const DetectorWork work = compare(
      builtin_avatar(), GetParam(), 7, frames, [&](const DetectorFrame&, const auto& row, const auto& expected) {
        for (std::size_t column = 0; column < row.size(); ++column) {
          contacts += expected[column].hit() ? 1U : 0U;
          if (row[column].triangle == expected[column].triangle && row[column].t == expected[column].t) continue;
          ++wrong;
          ADD_FAILURE() << "frame " << k << ", column " << column << ": triangle " << row[column].triangle << " at "
                        << row[column].t << ", not " << expected[column].triangle << " at " << expected[column].t;
        }
        if (wrong > 5) FAIL() << "and so on";
        ++k;
      });
  EXPECT_GT(contacts, static_cast<std::uint64_t>(frames) / 10);
  EXPECT_GT(work.pairs_spared, static_cast<std::uint64_t>(frames) * kColliders * 8);
}

INSTANTIATE_TEST_SUITE_P(Each, Coherence, ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST(CoherentWork, DependsNeitherOnWhereAPassBeginsNorOnTheInstructionSet) {
  const auto scene = test::scene("swarm", builtin_avatar(), 40, 700, 1000);
  for (const Method method : {Method::kStatic, Method::kCcd}) {
    const auto work_from = [&](std::size_t begin) {
      const auto cpu =
          make_cpu_detector(builtin_avatar(), builtin_map(), {Surface::kAll, kHashedPlanes, method, Skip::kOn});
      FrameBuilder builder = test::frame_builder(builtin_avatar(), 40, method);
      ContactRow row;
      DetectorWork work;
      for (std::size_t k = begin - 1; k < scene.size(); ++k) {
        const DetectorWork of_frame = cpu->detect(builder.next(scene[k]), row);
        if (k >= 512) work += of_frame;
      }
      return work;
    };
    const DetectorWork expected = work_from(1);
    EXPECT_GT(expected.pairs_spared, 0U);
    const auto expect_same = [&](const DetectorWork& work, const std::string& what) {
      EXPECT_EQ(work.pairs_tested, expected.pairs_tested) << what;
      EXPECT_EQ(work.meshlets_skinned, expected.meshlets_skinned) << what;
      EXPECT_EQ(work.pairs_spared, expected.pairs_spared) << what;
    };
    expect_same(work_from(256), "from 255 on");
    expect_same(work_from(512), "from 511 on");
    test::on_every_simd_target([&](const char* target) { expect_same(work_from(512), target); });
  }
}

TEST(CoherentWork, IsGivenUpUntilTheNextRestartWhereTooMuchIsNear) {
  const auto frames_that_spare = [](const char* scenario, std::uint32_t colliders, double rate_hz) {
    const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), {.skip = Skip::kOn});
    FrameBuilder builder = test::frame_builder(builtin_avatar(), colliders, Method::kStatic);
    ContactRow row;
    std::vector<std::uint64_t> frames;
    for (const TraceFrame& frame : test::scene(scenario, builtin_avatar(), colliders, 262, rate_hz))
      if (cpu->detect(builder.next(frame), row).pairs_spared > 0) frames.push_back(frame.index);
    return frames;
  };
  EXPECT_GT(frames_that_spare("swarm", 50, 1000).size(), 250U);
  const std::vector<std::uint64_t> spare = frames_that_spare("hug", 1000, 200);
  const auto before_restart = std::ranges::count_if(spare, [](std::uint64_t frame) { return frame < 256; });
  EXPECT_GT(before_restart, 0);
  EXPECT_LT(before_restart, 30);
  EXPECT_GT(std::ssize(spare), before_restart);
}

TEST(CoherentWork, OfALargeMeshGoesDownTheTree) {
  const auto path = test::data("avatars/avatars/MakeHumanBase_cc0_8inf.glb");
  VESTIGE_REQUIRE_DATA(path);
  const Avatar avatar = parse_avatar_glb(read_avatar_glb(path), "MakeHumanBase");
  const auto scene = test::scene("hug", avatar, 30, 60, 1000);
  const auto off =
      make_cpu_detector(avatar, builtin_map(), {Surface::kAll, kHashedPlanes, Method::kStatic, Skip::kOff});
  const auto on = make_cpu_detector(avatar, builtin_map(), {Surface::kAll, kHashedPlanes, Method::kStatic, Skip::kOn});
  EXPECT_EQ(hash_of(test::run_scene(scene, avatar, 30, *on)), hash_of(test::run_scene(scene, avatar, 30, *off)));
}

TEST(PartMotion, IsNeverLessThanAVertexMoves) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    test::RandomRig rig({.seed = seed,
                         .triangles = 300,
                         .entries = 12,
                         .influences = 4,
                         .mesh_size = static_cast<int>(seed % 7) - 3,
                         .mesh_offset = static_cast<int>(seed % 5),
                         .matrix_size = 0,
                         .translation_size = 1});
    const Meshlets meshlets(rig.avatar);
    PartMotion motion(rig.avatar, meshlets, 0);
    const std::vector<SkinMatrix> before = rig.palette();
    std::vector<SkinMatrix> now = before;
    for (SkinMatrix& matrix : now)
      for (glm::vec4& column : matrix.column) column += glm::vec4(rig.vector(0x1p-9F), 0);
    const std::span<const float> steps_m = motion.between(before, now);
    double closest = 0;
    for (std::size_t meshlet = 0; meshlet < meshlets.size(); ++meshlet) {
      double farthest_m = 0;
      for (const std::uint32_t triangle : meshlets.triangles(meshlet))
        for (int corner = 0; corner < 3; ++corner) {
          const std::size_t vertex = rig.avatar.triangles[triangle][corner];
          glm::dvec3 moved(0);
          for (std::size_t k = 0; k < rig.avatar.influence_count; ++k) {
            const Influences& influences = rig.avatar.influences[vertex];
            const glm::dvec3 x(rig.avatar.position_bind[vertex]);
            const auto place = [&](const SkinMatrix& m) {
              return glm::dvec3(m.column[0]) * x.x + glm::dvec3(m.column[1]) * x.y + glm::dvec3(m.column[2]) * x.z +
                     glm::dvec3(m.column[3]);
            };
            const std::size_t entry = influences.palette[k];
            moved += double{influences.weight[k]} * (place(now[entry]) - place(before[entry]));
          }
          farthest_m = std::max(farthest_m, glm::length(moved));
        }
      EXPECT_GE(double{steps_m[meshlet]}, farthest_m) << "seed " << seed;
      closest = std::max(closest, farthest_m / double{steps_m[meshlet]});
    }
    EXPECT_GT(closest, 0.2) << "a bound that is not useless";
  }
}

}  // namespace
}  // namespace vestige
