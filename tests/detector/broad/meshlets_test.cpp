// Meshlets and their bounds: whatever the rig, no vertex leaves its boxes, and no pair that may meet is left out.

#include "detector/broad/meshlets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "detector/broad/meet_boxes.hpp"
#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/meshlet_candidates.hpp"
#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlet_triangles.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/broad/triangle_boxes.hpp"
#include "detector/decision.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/random_rig.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

constexpr Method kMethods[] = {Method::kStatic, Method::kCarried, Method::kCcd};

/// The meshlet of each triangle. Fails where one has none, or several.
std::vector<std::size_t> meshlet_of_triangle(const Avatar& avatar, const Meshlets& meshlets) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> meshlet_of(avatar.triangles.size(), kNone);
  for (std::size_t m = 0; m < meshlets.size(); ++m) {
    EXPECT_TRUE(std::ranges::is_sorted(meshlets.triangles(m)));
    for (const std::uint32_t triangle : meshlets.triangles(m)) {
      EXPECT_EQ(meshlet_of[triangle], kNone);
      meshlet_of[triangle] = m;
    }
  }
  EXPECT_EQ(std::ranges::count(meshlet_of, kNone), 0);
  return meshlet_of;
}

TEST(Meshlets, HoldEveryTriangleOnceHoweverManyThereAre) {
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  for (const std::size_t count : {1U, 2U, 31U, 32U, 33U, 256U, 257U, 5000U}) {
    SCOPED_TRACE(count);
    const Avatar degenerate = test::rigid_avatar(corners, std::vector<glm::uvec3>(count, {0, 1, 1}));
    const Meshlets meshlets(degenerate);
    EXPECT_EQ(meshlets.size(), (count + kMeshletTriangles - 1) / kMeshletTriangles);
    EXPECT_EQ(meshlets.nodes(meshlets.levels() - 1), 1U);
    meshlet_of_triangle(degenerate, meshlets);
  }
  meshlet_of_triangle(builtin_avatar(), Meshlets(builtin_avatar()));
}

TEST(Meshlets, OfAMeshWithoutTrianglesAreNone) {
  const Avatar empty = test::rigid_avatar({{0, 0, 0}}, {});
  const Meshlets meshlets(empty);
  EXPECT_EQ(meshlets.size(), 0U);
  MeshletCandidates candidates(empty, meshlets);
  const DetectorFrame frame = test::frame_of(empty, {{0, {0, 0, 0}, {1, 1, 1}}});
  candidates.find(frame, {frame.segments, {}}, Method::kStatic);
  EXPECT_TRUE(candidates.touched().empty());
}

TEST(Meshlets, OfAMillionTrianglesInOnePlaceAreMadeAndBounded) {
  const Avatar heap =
      test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<glm::uvec3>(1'000'000, {0, 1, 2}));
  const Meshlets meshlets(heap);
  MeshletCandidates candidates(heap, meshlets);
  const DetectorFrame through = test::frame_of(heap, {{0, {0.2F, 0.2F, -1}, {0.2F, 0.2F, 1}}});
  candidates.find(through, {through.segments, {}}, Method::kStatic);
  EXPECT_EQ(candidates.touched().size(), meshlets.size());
  const DetectorFrame above = test::frame_of(heap, {{0, {0.2F, 0.2F, 1}, {0.2F, 0.2F, 2}}});
  candidates.find(above, {above.segments, {}}, Method::kStatic);
  EXPECT_TRUE(candidates.touched().empty());
}

TEST(Meshlets, AreSmallPatchesOfTheBody) {
  const Meshlets meshlets(builtin_avatar());
  MeshletBounds bounds(builtin_avatar(), meshlets);
  bounds.begin(test::frame_of(builtin_avatar(), {}), Method::kStatic);
  std::vector<SkinBox> boxes(meshlets.size());
  bounds.boxes(0, 0, boxes);
  double sum_m = 0;
  for (const SkinBox& box : boxes) sum_m += static_cast<double>(glm::length(glm::vec3(box.high - box.low)));
  EXPECT_LT(sum_m / static_cast<double>(boxes.size()), 0.25);
}

bool inside(const glm::vec3& point, const SkinBox& box) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(point[axis] >= box.low[axis] && point[axis] <= box.high[axis])) return false;
  return true;
}

test::RigShape any_rig() {
  const auto power = rc::gen::inRange(-40, 41);
  test::RigShape shape;
  shape.seed = *rc::gen::arbitrary<std::uint64_t>();
  shape.triangles = *rc::gen::inRange(1, 400);
  shape.entries = *rc::gen::inRange(1, 40);
  shape.influences = *rc::gen::inRange(1, 9);
  shape.mesh_size = *power;
  shape.mesh_offset = *power;
  shape.matrix_size = *power;
  shape.translation_size = *power;
  return shape;
}

/// Any rig within a frame: its skin, and where its meshlets are said to be.
class BoundedRig {
 public:
  BoundedRig() {
    frame_.palette = rig_.palette();
    frame_.palette_before = rig_.palette();
  }

  const Avatar& avatar() const { return rig_.avatar; }

  /// Calls visit(box of a node, triangle of it, skin) for all triangles and all nodes that they are in.
  template <typename Visit>
  void visit_boxes(Method method, Visit&& visit) {
    bounds_.begin(frame_, method);
    SkinMotion skin;
    skin.skin(rig_.avatar, frame_, method);
    std::size_t meshlets_a_node = 1;
    for (std::size_t level = 0; level < meshlets_.levels(); ++level, meshlets_a_node *= kMeshletFanout) {
      std::vector<SkinBox> boxes(meshlets_.nodes(level));
      bounds_.boxes(level, 0, boxes);
      for (std::size_t m = 0; m < meshlets_.size(); ++m)
        for (const std::uint32_t triangle : meshlets_.triangles(m)) visit(boxes[m / meshlets_a_node], triangle, skin);
    }
  }

 private:
  test::RandomRig rig_{any_rig()};
  Meshlets meshlets_{rig_.avatar};
  MeshletBounds bounds_{rig_.avatar, meshlets_};
  DetectorFrame frame_;
};

RC_GTEST_PROP(MeshletBounds, HoldEverySkinnedVertexOfAnyRig, ()) {
  BoundedRig rig;
  for (const Method method : {Method::kStatic, Method::kCcd}) {
    rig.visit_boxes(method, [&](const SkinBox& box, std::uint32_t triangle, const SkinMotion& skin) {
      const glm::uvec3& corners = rig.avatar().triangles[triangle];
      for (int corner = 0; corner < 3; ++corner) {
        RC_ASSERT(inside(skin.now[corners[corner]], box));
        if (method == Method::kCcd) RC_ASSERT(inside(skin.before[corners[corner]], box));
      }
    });
  }
}

RC_GTEST_PROP(MeshletBounds, HoldEveryStartThatIsCarriedIntoATriangle, ()) {
  BoundedRig rig;
  rig.visit_boxes(Method::kCarried, [&](const SkinBox& box, std::uint32_t triangle, const SkinMotion& skin) {
    const auto [before, now] = moving_corners(rig.avatar(), skin, Method::kCarried, triangle);
    const glm::dvec3 low = glm::min(glm::min(now.a, now.b), now.c);
    const glm::dvec3 high = glm::max(glm::max(now.a, now.b), now.c);
    for (const glm::dvec3& corner : {low, high}) {
      const glm::vec3 start(corner - carried_displacement(before, now));
      const glm::dvec3 carried(carried_start(start, before, now));
      for (int axis = 0; axis < 3; ++axis)
        if (carried[axis] >= low[axis] && carried[axis] <= high[axis])
          RC_ASSERT(start[axis] >= box.low[axis] && start[axis] <= box.high[axis]);
      RC_ASSERT(inside(glm::vec3(corner), box));  // where a segment may end
    }
  });
}

TEST(MeshletBounds, AreNoneWhereAPaletteMayOverflowOrAWeightIsNegative) {
  Avatar avatar = test::rigid_avatar({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const Meshlets meshlets(avatar);
  DetectorFrame frame = test::frame_of(avatar, {});
  const auto box = [&] {
    MeshletBounds bounds(avatar, meshlets);
    bounds.begin(frame, Method::kStatic);
    SkinBox out;
    bounds.boxes(0, 0, std::span(&out, 1));
    return out;
  };
  const glm::vec3 far(1e30F, -1e30F, 1e30F);
  EXPECT_FALSE(inside(far, box()));
  for (const float strange : {3e38F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    frame.palette[0].column[1].y = strange;
    EXPECT_TRUE(inside(far, box())) << strange;
  }
  frame = test::frame_of(avatar, {});
  avatar.influences[1].weight[0] = -1;
  EXPECT_TRUE(inside(far, box()));
}

TEST(MeshletBounds, AreNoneWhereverInAPaletteSomethingIsNoNumber) {
  constexpr int kEntries = 21;
  test::RandomRig rig({.seed = 3, .triangles = 400, .entries = kEntries, .influences = 4});
  const Meshlets meshlets(rig.avatar);
  MeshletBounds bounds(rig.avatar, meshlets);
  DetectorFrame frame;
  frame.palette = frame.palette_before = rig.palette();
  const auto root_is_bounded = [&](Method method) {
    bounds.begin(frame, method);
    SkinBox root;
    bounds.boxes(meshlets.levels() - 1, 0, std::span(&root, 1));
    return !inside(glm::vec3(1e30F, -1e30F, 1e30F), root);
  };
  for (const Method method : kMethods) {
    EXPECT_TRUE(root_is_bounded(method));
    for (std::vector<SkinMatrix>* palette : {&frame.palette, &frame.palette_before}) {
      if (method == Method::kStatic && palette == &frame.palette_before) continue;  // not read
      for (std::size_t entry = 0; entry < kEntries; ++entry)
        for (std::size_t column = 0; column < 4; ++column)
          for (int axis = 0; axis < 3; ++axis) {
            float& number = (*palette)[entry].column[column][axis];
            const float kept = std::exchange(number, std::numeric_limits<float>::quiet_NaN());
            EXPECT_FALSE(root_is_bounded(method)) << "entry " << entry << ", column " << column << ", axis " << axis;
            number = kept;
          }
    }
  }
}

TEST(SkinVertices, HaveTheBitsOfSkinVertexOnEveryInstructionSet) {
  test::on_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    for (const int influences : {1, 4, 8}) {
      test::RandomRig rig({.seed = 7, .triangles = 500, .entries = 30, .influences = influences, .matrix_size = 1});
      const std::vector<SkinMatrix> palette = rig.palette();
      std::vector<glm::vec3> found;
      skin_vertices(rig.avatar, palette, found);
      for (std::size_t vertex = 0; vertex < found.size(); ++vertex) {
        const glm::vec3 expected = skin_vertex(rig.avatar, palette, vertex);
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_EQ(std::bit_cast<std::uint32_t>(found[vertex][axis]), std::bit_cast<std::uint32_t>(expected[axis]));
      }
    }
  });
}

TEST(MeshletSkin, HasTheBitsOfSkinVertexOnEveryInstructionSet) {
  test::on_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    for (const int entries : {1, 3, 17, 400}) {
      test::RandomRig rig({.seed = 5, .triangles = 100, .entries = entries, .influences = 8, .matrix_size = 1});
      const Meshlets meshlets(rig.avatar);
      const MeshletSkin skin(rig.avatar, meshlets);
      const std::vector<SkinMatrix> palette = rig.palette();
      MeshletCorners corners;
      for (std::size_t m = 0; m < meshlets.size(); ++m) {
        skin.skin(m, palette, corners);
        for (std::size_t i = 0; i < meshlets.triangles(m).size(); ++i)
          for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = rig.avatar.triangles[meshlets.triangles(m)[i]][static_cast<int>(corner)];
            const glm::vec3 expected = skin_vertex(rig.avatar, palette, vertex);
            const glm::vec3 found = corners.at(corner, i);
            for (int axis = 0; axis < 3; ++axis)
              ASSERT_EQ(std::bit_cast<std::uint32_t>(found[axis]), std::bit_cast<std::uint32_t>(expected[axis]));
          }
      }
    }
  });
}

TEST(MeetBoxes, SaysThatTouchingIsMeetingAndThatWhatIsNoNumberMayMeetOnEveryInstructionSet) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const SkinBox unit = {glm::vec4(0, 0, 0, 0), glm::vec4(1, 1, 1, 0)};
  const SkinBox nowhere = {glm::vec4(7, 7, 7, 0), glm::vec4(8, 8, 8, 0)};
  const SkinBox anywhere = {glm::vec4(kNan), glm::vec4(kNan)};
  const std::vector<SkinBox> boxes = {unit, nowhere, anywhere};
  test::on_every_simd_target([&](const char* target) {
    SCOPED_TRACE(target);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<std::array<float, kBoxBlock>, 6> ends = {};  // boxes of points at 0.5, but for some along one axis
      for (auto& numbers : ends) numbers.fill(0.5F);
      const auto place = [&](std::size_t i, float low, float high) {
        ends[axis][i] = low;
        ends[axis + 3][i] = high;
      };
      place(3, -1, 0);
      place(7, 1, 2);
      place(11, -1, -1e-30F);
      place(15, 1 + 0x1p-23F, 2);
      place(19, kNan, kNan);
      place(23, -1, 2);
      std::array<std::uint32_t, 3> meets = {};
      meet_boxes(boxes, ends[0].data(), kBoxBlock, kBoxBlock, meets.data());
      EXPECT_EQ(meets[0], ~(1U << 11 | 1U << 15));
      EXPECT_EQ(meets[1], 0U);
      EXPECT_EQ(meets[2], ~0U);
      meet_boxes(boxes, ends[0].data(), kBoxBlock, 5, meets.data());
      EXPECT_EQ(meets[0], 0x1FU);
      EXPECT_EQ(meets[2], 0x1FU);
    }
  });
}

/// Segments that end on the triangle, touch it with an end, go through it, or pass close by.
std::vector<Segment> segments_around(test::RandomRig& rig, const Corners& before, const Corners& now, float reach) {
  std::vector<Segment> segments;
  for (const glm::dvec3& weight : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0.5, 0.5), glm::dvec3(0.25, 0.25, 0.5)}) {
    const glm::vec3 first(weight.x * before.a + weight.y * before.b + weight.z * before.c);
    const glm::vec3 last(weight.x * now.a + weight.y * now.b + weight.z * now.c);
    const glm::vec3 back(glm::dvec3(last) - carried_displacement(before, now));
    const glm::vec3 aside = rig.vector(reach);
    segments.push_back({0, last + aside, last});
    segments.push_back({0, back, back + aside});
    segments.push_back({0, first, last + aside});
    segments.push_back({0, last - aside, last + aside});
    segments.push_back({0, glm::vec3(now.a), glm::vec3(now.b)});
  }
  return segments;
}

RC_GTEST_PROP(MeshletTriangles, RejectNoPairThatMeets, ()) {
  test::RigShape shape = any_rig();
  shape.triangles = *rc::gen::inRange(1, 40);
  shape.matrix_size = *rc::gen::inRange(-3, 4);
  shape.mesh_size = *rc::gen::inRange(-12, 4);
  shape.mesh_offset = *rc::gen::inRange(-12, 8);
  shape.translation_size = *rc::gen::inRange(-12, 8);
  const float reach = std::ldexp(1.0F, *rc::gen::inRange(-14, 4));
  test::RandomRig rig(shape);
  const Meshlets meshlets(rig.avatar);
  const MeshletSkin skin(rig.avatar, meshlets);
  const std::vector<SkinMatrix> palette = rig.palette();
  std::vector<SkinMatrix> palette_before = palette;  // a little aside
  for (SkinMatrix& matrix : palette_before) matrix.column[3] += glm::vec4(rig.vector(reach), 0);
  MeshletCorners now;
  MeshletCorners before;
  for (const Method method : kMethods)
    for (std::size_t m = 0; m < meshlets.size(); ++m) {
      skin.skin(m, palette, now);
      skin.skin(m, palette_before, before);
      MeshletTriangles triangles;
      triangles.bound(now, before, method);
      for (std::size_t i = 0; i < meshlets.triangles(m).size(); ++i) {
        const Corners corners = now.corners(i);
        const Corners corners_before = before.corners(i);
        for (const Segment& segment : segments_around(rig, corners_before, corners, reach)) {
          Way way = {glm::dvec3(segment.start), glm::dvec3(segment.end)};
          if (method == Method::kCarried) way.start = glm::dvec3(carried_start(segment.start, corners_before, corners));
          const Decision decision =
              method == Method::kCcd ? decide_ccd(way, corners_before, corners) : decide_static(way, corners);
          const std::uint32_t number = 0;
          std::uint32_t meets = 0;
          triangles.meet({std::span(&segment, 1), {}}, std::span(&number, 1), &meets);
          if (decision.contact) RC_ASSERT(((meets >> i) & 1U) == 1U);
        }
      }
    }
}

TEST(MeshletTriangles, RejectMostOfWhatPassesCloseBy) {
  const Avatar avatar = test::rigid_avatar({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0.5F}}, {{0, 1, 2}});
  const Meshlets meshlets(avatar);
  const MeshletSkin skin(avatar, meshlets);
  const DetectorFrame frame = test::frame_of(avatar, {});
  MeshletCorners corners;
  skin.skin(0, frame.palette, corners);
  MeshletTriangles triangles;
  triangles.bound(corners, corners, Method::kStatic);
  const Segment beside = {0, {0, 0, 0.249F}, {0, -0.1F, 0.1F}};  // within the box, on one side of the plane
  const Segment through = {0, {0, 0, 0.249F}, {0, 0, 0.3F}};
  const std::vector<Segment> segments = {beside, through};
  const std::uint32_t numbers[] = {0, 1};
  std::uint32_t meets[2];
  triangles.meet({segments, {}}, numbers, meets);
  EXPECT_EQ(meets[0] & 1U, 0U);
  EXPECT_EQ(meets[1] & 1U, 1U);
}

TEST(MeshletCandidates, AreTheSameOnEveryInstructionSetAndLeaveOutNoPairWhoseBoxesMeet) {
  const auto scene = test::scene("swarm", builtin_avatar(), 100, 12, 20);
  const Meshlets meshlets(builtin_avatar());
  const std::vector<std::size_t> meshlet_of = meshlet_of_triangle(builtin_avatar(), meshlets);
  MeshletCandidates candidates(builtin_avatar(), meshlets);
  for (const Method method : kMethods) {
    FrameBuilder builder = test::frame_builder(builtin_avatar(), 100, method);
    std::size_t pairs = 0;
    std::size_t meshlet_pairs = 0;
    for (const TraceFrame& trace_frame : scene) {
      const DetectorFrame& frame = builder.next(trace_frame);
      using Pair = std::pair<std::size_t, std::uint32_t>;  // meshlet, segment
      std::vector<std::vector<Pair>> found;
      test::on_every_simd_target([&](const char*) {
        candidates.find(frame, {frame.segments, {}}, method);
        auto& listed = found.emplace_back();
        for (const TouchedMeshlet& touched : candidates.touched())
          for (const std::uint32_t segment : candidates.segments(touched))
            listed.emplace_back(touched.meshlet, segment);
      });
      EXPECT_TRUE(std::ranges::is_sorted(found.front()));
      for (const auto& other : found) EXPECT_EQ(other, found.front());
      meshlet_pairs += found.front().size();

      SkinMotion skin;
      skin.skin(builtin_avatar(), frame, method);
      TriangleBoxes boxes;
      boxes.build(builtin_avatar(), skin, method);
      for (std::uint32_t segment = 0; segment < frame.segments.size(); ++segment)
        boxes.meet(frame.segments[segment], [&](std::uint32_t triangle) {
          ++pairs;
          EXPECT_TRUE(std::ranges::binary_search(found.front(), Pair(meshlet_of[triangle], segment)));
        });
    }
    EXPECT_GT(pairs, 100U);
    EXPECT_LT(meshlet_pairs, scene.size() * 100 * meshlets.size() / 10);
  }
}

}  // namespace
}  // namespace vestige
