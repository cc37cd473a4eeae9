#include "analysis/stress/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "analysis/stress/stress_report.hpp"
#include "detector/algebra/winding_number.hpp"
#include "detector/detectors/embree_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/skinning.hpp"
#include "tests/support/skin_geometry.hpp"
#include "tests/support/small_avatar.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

bool keep_going(double) {
  return true;
}

StressContestant cpu(Method method) {
  return {"cpu", method, [method](const StressSubject& subject) {
            return make_cpu_detector(subject.avatar, subject.map, {Surface::kAll, PlaneSet::all(), method});
          }};
}

std::vector<StressFamily> family(std::string_view name) {
  std::vector<StressFamily> families = stress_families();
  std::erase_if(families, [&](const StressFamily& one) { return one.name != name; });
  return families;
}

/// Finds what `cpu` finds, and then gets one thing wrong.
class WrongDetector final : public Detector {
 public:
  enum class Fault { kMisses, kInvents, kNextTriangle, kLaterTime, kOtherActuator };

  WrongDetector(const StressSubject& subject, Fault fault)
      : right_(make_cpu_detector(subject.avatar, subject.map, {Surface::kAll, PlaneSet::all(), Method::kStatic})),
        fault_(fault) {}

  const char* name() const override { return "wrong"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    const DetectorWork work = right_->detect(frame, row);
    for (Contact& contact : row) {
      if (fault_ == Fault::kInvents && !contact.hit()) contact.triangle = 0;
      if (!contact.hit()) continue;
      if (fault_ == Fault::kMisses) contact = Contact();
      if (fault_ == Fault::kNextTriangle) ++contact.triangle;
      if (fault_ == Fault::kLaterTime) contact.t += 0.5F;
      if (fault_ == Fault::kOtherActuator) ++contact.actuator;
    }
    return work;
  }
  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    right_->skinned_vertices(frame, out);
  }

 private:
  std::unique_ptr<Detector> right_;
  Fault fault_;
};

StressCount count_of(WrongDetector::Fault fault) {
  const StressContestant wrong = {"wrong", Method::kStatic, [fault](const StressSubject& subject) {
                                    return std::make_unique<WrongDetector>(subject, fault);
                                  }};
  return run_stress(family("edge"), {wrong}, {200, 1}, keep_going).front();
}

TEST(Stress, CpuGetsNothingWrongInAnyFamily) {
  const auto counts = run_stress(stress_families(), {cpu(Method::kStatic), cpu(Method::kCcd)}, {24, 7}, keep_going);
  for (const StressCount& count : counts) {
    EXPECT_EQ(count.felt() + count.wrong_winner, 0U)
        << count.family.name << " " << count.magnitude << " " << name_of(count.method);
    EXPECT_EQ(count.cases, 24U) << count.family.name;
  }
}

TEST(Stress, FamiliesAreThoseOfTheNotes) {
  std::set<std::string_view> names;
  for (const StressFamily& one : stress_families()) {
    names.insert(one.name);
    EXPECT_TRUE(one.meaning.ends_with('.')) << one.name;
    EXPECT_FALSE(one.magnitudes.empty()) << one.name;
  }
  EXPECT_THAT(
      names, UnorderedElementsAre("vertex", "edge", "coplanar", "grazing", "needle", "zero_length", "endpoint", "ulp",
                                  "offset", "scale", "degenerate", "denormal", "non_finite", "collapse", "spin",
                                  "teleport", "texel_border", "mirrored", "watertight", "sphere_tangent", "sphere_rest",
                                  "sphere_tie", "sphere_size", "sphere_offset", "sphere_degenerate"));
}

TEST(Stress, CasesTouchWhatTheyAimAt) {
  const auto counts = run_stress(stress_families(), {cpu(Method::kStatic)}, {64, 3}, keep_going);
  std::map<std::string_view, std::uint64_t> contacts;
  for (const StressCount& count : counts) contacts[count.family.name] += count.contacts;
  for (const StressFamily& one : stress_families()) EXPECT_GT(contacts[one.name], 10U) << one.name;
}

TEST(Stress, LeavesOutOfSpheresWhoTestsOnlyTheirCentres) {
  StressContestant centres = cpu(Method::kStatic);
  centres.takes_radii = false;
  EXPECT_TRUE(run_stress(family("sphere_rest"), {centres}, {8, 1}, keep_going).empty());
  EXPECT_EQ(run_stress(family("edge"), {centres}, {8, 1}, keep_going).front().cases, 8U);
}

TEST(Stress, EachKindOfErrorIsCounted) {
  using Fault = WrongDetector::Fault;
  const StressCount missing = count_of(Fault::kMisses);
  EXPECT_EQ(missing.false_negatives, missing.contacts);
  EXPECT_GT(missing.false_negatives, 0U);
  EXPECT_EQ(missing.wrong_winner, 0U);
  const StressCount inventing = count_of(Fault::kInvents);
  EXPECT_EQ(inventing.false_positives, inventing.cases - inventing.contacts);
  EXPECT_GT(inventing.false_positives, 0U);
  const StressCount elsewhere = count_of(Fault::kNextTriangle);
  EXPECT_EQ(elsewhere.wrong_triangle, elsewhere.contacts);
  EXPECT_EQ(elsewhere.wrong_winner, elsewhere.contacts);
  const StressCount late = count_of(Fault::kLaterTime);
  EXPECT_EQ(late.wrong_winner, late.contacts);
  EXPECT_EQ(late.felt(), 0U);
  EXPECT_EQ(count_of(Fault::kOtherActuator).wrong_actuator, missing.contacts);
}

TEST(Stress, EqualSeedsGiveEqualCountsWhicheverFamiliesRun) {
  const StressContestant robust = {"embree", Method::kStatic, [](const StressSubject& subject) {
                                     return make_embree_detector(EmbreeMode::kRobust, subject.avatar, subject.map, {});
                                   }};
  const auto alone = run_stress(family("vertex"), {robust}, {300, 5}, keep_going);
  std::vector<StressFamily> more = family("edge");
  for (const StressFamily& one : family("vertex")) more.push_back(one);
  const auto among = run_stress(more, {robust, cpu(Method::kStatic)}, {300, 5}, keep_going);
  std::vector<StressCount> same;
  std::ranges::copy_if(among, std::back_inserter(same), [](const StressCount& count) {
    return count.family.name == "vertex" && count.detector == "embree";
  });
  EXPECT_EQ(to_json(alone).dump(), to_json(same).dump());
  EXPECT_NE(to_json(alone).dump(), to_json(run_stress(family("vertex"), {robust}, {300, 6}, keep_going)).dump());
}

TEST(Stress, TheTableShowsAZeroOnlyWhereNothingIsWrong) {
  StressCount good;
  good.family = family("edge").front();
  good.detector = "cpu";
  good.cases = 10;
  StressCount bad = good;
  bad.detector = "paper";
  bad.false_negatives = 3;
  bad.wrong_winner = 4;
  bad.wrong_triangle = 1;
  const std::array counts = {good, bad};
  EXPECT_THAT(stress_table(counts), HasSubstr("3/0/1/3"));
  EXPECT_EQ(to_json(counts)[0]["false_negatives"], 0);
  EXPECT_EQ(to_json(counts)[1]["wrong_winner"], 4);
  const double share = to_json(counts)[1]["felt_share"];
  EXPECT_GT(share, 0);
  EXPECT_LT(to_json(counts)[1]["felt_share_low"], share);
  EXPECT_GT(to_json(counts)[1]["felt_share_high"], share);
  EXPECT_EQ(to_json(counts)[0]["felt_share_low"], 0);
  EXPECT_GT(to_json(counts)[0]["felt_share_high"], 0);
  EXPECT_THAT(stress_table(counts), HasSubstr("nowhere: less than"));
  EXPECT_THAT(family_definitions(), HasSubstr("edge: Segments through an edge that two triangles share."));
}

TEST(WindingNumber, CountsTheShellsAroundAPointAndRefusesTheSurface) {
  // Two boxes, one within the other, fronts outwards.
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (const float size : {1.0F, 2.0F}) {
    const auto first = static_cast<glm::uint>(vertices.size());
    for (const float x : {-size, size})
      for (const float y : {-size, size})
        for (const float z : {-size, size}) vertices.emplace_back(x, y, z);
    for (const glm::uvec3& face : test::box_faces()) triangles.push_back(face + first);
  }
  EXPECT_EQ(winding_number(vertices, triangles, {0.25F, 0.5F, 0.125F}), 2);
  EXPECT_EQ(winding_number(vertices, triangles, {0, 0, 0}), 2);  // its half-line runs along a diagonal of a face
  EXPECT_EQ(winding_number(vertices, triangles, {1.5F, 1, 1}), 1);
  EXPECT_EQ(winding_number(vertices, triangles, {-1.5F, 0.5F, 0.5F}), 1);  // through a diagonal of the inner box
  EXPECT_EQ(winding_number(vertices, triangles, {-3, 1.5F, 1.5F}), 0);     // in and out again, along diagonals
  EXPECT_EQ(winding_number(vertices, triangles, {3, 0, 0}), 0);
  EXPECT_EQ(winding_number(vertices, triangles, {1, 0.5F, 0.25F}), std::nullopt);
}

TEST(Embree, FindsAnOrdinaryContactInBothConfigurations) {
  const Avatar avatar = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const ActuatorMap map;
  const DetectorFrame frame =
      test::frame_of(avatar, {{0, {0.25F, 0.25F, 1}, {0.25F, 0.25F, -1}}, {1, {2, 2, 1}, {2, 2, -1}}});
  for (const EmbreeMode mode : {EmbreeMode::kRobust, EmbreeMode::kDefault}) {
    const auto detector = make_embree_detector(mode, avatar, map, {});
    ContactRow row;
    detector->detect(frame, row);
    ASSERT_EQ(row.size(), 2U);
    EXPECT_EQ(row[0].triangle, 0U);
    EXPECT_EQ(row[0].t, 0.5F);
    EXPECT_EQ(row[0].side, 1);
    EXPECT_FALSE(row[1].hit());
  }
}

TEST(Embree, PassesThroughSkinWithoutAnActuatorWhereItIsTold) {
  // The upper triangle's texture coordinates lie in the map's left half, which has no actuator.
  Avatar avatar = test::rigid_avatar(
      {{0, 0, 0}, {0.4F, 0, 0}, {0, 1, 0}, {0, 0, -0.5F}, {0.4F, 0, -0.5F}, {0, 1, -0.5F}}, {{0, 1, 2}, {3, 4, 5}});
  for (std::size_t i = 3; i < 6; ++i) avatar.texture_coordinate[i].x += 0.5F;
  ActuatorMap map;
  map.width = 2;
  map.actuator = {0, 1};
  map.actuator_count = 1;
  const DetectorFrame frame = test::frame_of(avatar, {{0, {0.1F, 0.1F, 1}, {0.1F, 0.1F, -1}}});
  ContactRow row;
  make_embree_detector(EmbreeMode::kRobust, avatar, map, {Surface::kAll, PlaneSet::all()})->detect(frame, row);
  EXPECT_EQ(row[0].triangle, 0U);
  EXPECT_EQ(row[0].actuator, 0);
  make_embree_detector(EmbreeMode::kRobust, avatar, map, {Surface::kMapped, PlaneSet::all()})->detect(frame, row);
  EXPECT_EQ(row[0].triangle, 1U);
  EXPECT_EQ(row[0].actuator, 1);
}

TEST(Embree, RefusesWhatItCannotDo) {
  const Avatar avatar = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const ActuatorMap map;
  EXPECT_THROW(make_embree_detector(EmbreeMode::kRobust, avatar, map, {Surface::kAll, {}, Method::kCcd}), UsageError);
}

}  // namespace
}  // namespace vestige
