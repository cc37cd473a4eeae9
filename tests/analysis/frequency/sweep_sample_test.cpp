// Which frames and which colliders stand for a trace.

#include "analysis/frequency/sweep_sample.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

TEST(DrawnColliders, AreOtherOnesAtEveryPlaceAsFarAsTheyLast) {
  std::vector<std::uint32_t> ids(100);
  for (std::uint32_t i = 0; i < 100; ++i) ids[i] = 1000 + 3 * i;
  const auto drawn = draw_colliders(ids, 30, 10, 1);
  ASSERT_EQ(drawn.size(), 10U);
  EXPECT_THAT(drawn, Each(SizeIs(30)));
  std::map<std::uint32_t, int> times;
  for (const auto& place : drawn) {
    EXPECT_TRUE(std::ranges::is_sorted(place));
    EXPECT_EQ(std::ranges::adjacent_find(place), place.end()) << "drawn twice";
    for (const std::uint32_t id : place) ++times[id];
  }
  EXPECT_EQ(times.size(), 100U);
  for (const auto& [id, count] : times) EXPECT_EQ(count, 3) << id;
  EXPECT_NE(drawn[0], std::vector(ids.begin(), ids.begin() + 30)) << "not the first ids";
}

TEST(DrawnColliders, AreTheSameForTheSameSeedAndAllWhereAllAreAskedFor) {
  const std::vector<std::uint32_t> ids = {2, 3, 5, 7, 11, 13, 17, 19};
  EXPECT_EQ(draw_colliders(ids, 2, 3, 7), draw_colliders(ids, 2, 3, 7));
  EXPECT_NE(draw_colliders(ids, 2, 3, 7), draw_colliders(ids, 2, 3, 8));
  EXPECT_THAT(draw_colliders(ids, 8, 3, 7), Each(ids));
}

/// Finds a contact of the first collider in the frames whose numbers it is given.
class Scripted final : public Detector {
 public:
  explicit Scripted(std::function<bool(std::uint64_t)> touches) : touches_(std::move(touches)) {}
  const char* name() const override { return "scripted"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (touches_(frame.index)) row[0].triangle = 0;
    return {};
  }
  void skinned_vertices(const DetectorFrame& /*frame*/, std::vector<glm::vec3>& out) override { out.clear(); }

 private:
  std::function<bool(std::uint64_t)> touches_;
};

class SampledTrace : public ::testing::Test {
 protected:
  SampledTrace() { test::write_trace(path_, kFrames, test::steady_options()); }
  ~SampledTrace() override { std::filesystem::remove(path_); }

  SweepSample sample(std::function<bool(std::uint64_t)> touches, std::uint32_t places, std::uint32_t frames) {
    TraceReader trace(path_);
    Scripted survey(std::move(touches));
    const std::vector<DetectedPerson> people = {{0, avatar_, survey}};
    return sample_places(trace, people, places, frames, [] { return true; });
  }

  static constexpr std::uint64_t kFrames = 400;
  const Avatar avatar_ = test::skeleton(test::kNodes);
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "sampled.mcap";
};

/// Places that begin at the first frame, or end at the last, would see contacts always or never.
TEST_F(SampledTrace, HasContactsAsOftenAsTheWholeTrace) {
  const SweepSample sampled = sample([](std::uint64_t frame) { return frame % 100 < 30; }, 4, 10);
  EXPECT_NEAR(sampled.trace.empty_share, 0.7, 0.003);
  EXPECT_NEAR(sampled.trace.contacts_per_frame, 0.3, 0.003);
  EXPECT_NEAR(sampled.sampled.empty_share, 0.7, 0.05);
  ASSERT_EQ(sampled.places.size(), 4U);
  EXPECT_THAT(sampled.places, Each(SizeIs(11)));
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_EQ(sampled.places[i].front().index - sampled.places[i - 1].front().index, 100U);
  for (const Place& place : sampled.places) EXPECT_EQ(place.back().index - place.front().index, 10U);
}

/// One contact among 40 frames would be ten times as many as among the trace's 400.
TEST_F(SampledTrace, LeavesOutAContactThatItWouldOverrate) {
  const SweepSample sampled = sample([](std::uint64_t frame) { return frame == 399; }, 4, 10);
  EXPECT_GT(sampled.trace.contacts_per_frame, 0);
  EXPECT_EQ(sampled.sampled.contacts_per_frame, 0);
}

TEST_F(SampledTrace, HasAHashOfItsPosesAndColliders) {
  const auto never = [](std::uint64_t) { return false; };
  EXPECT_EQ(sample(never, 4, 10).sha256.size(), 64U);
  EXPECT_EQ(sample(never, 4, 10).sha256, sample(never, 4, 10).sha256);
  EXPECT_NE(sample(never, 4, 10).sha256, sample(never, 4, 11).sha256);
}

TEST_F(SampledTrace, HasNoMorePlacesThanRoom) {
  EXPECT_THAT(sample([](std::uint64_t) { return false; }, 1000, 99).places, SizeIs(4));
  const SweepSample whole = sample([](std::uint64_t) { return true; }, 5, 100000);
  ASSERT_THAT(whole.places, SizeIs(1));
  EXPECT_THAT(whole.places[0], SizeIs(kFrames));
}

}  // namespace
}  // namespace vestige
