#include "analysis/run/detector_team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

constexpr std::uint32_t kColliders = 20;
constexpr int kBatches = 5;

/// The detectors of a trace of one person.
PeopleDetectors only(std::unique_ptr<Detector> detector) {
  PeopleDetectors detectors;
  detectors.push_back(std::move(detector));
  return detectors;
}

PeopleDetectors make_cpu() {
  return only(make_cpu_detector(builtin_avatar(), builtin_map(), {}));
}

std::string hash_by(std::size_t threads) {
  const auto frames = test::scene("hug", builtin_avatar(), kColliders, 60, 60);
  DetectorTeam team(threads, make_cpu);
  FrameBuilder builder = test::frame_builder(builtin_avatar(), kColliders, Method::kStatic);
  TextureHash hash;
  FrameBatch batch;
  for (std::size_t next = 0; next < frames.size();) {
    batch.clear();
    for (std::size_t i = 0; i < frames.size() / kBatches && next < frames.size(); ++i)
      batch.add(builder.next(frames[next++]));
    team.start(batch);
    team.finish();
    for (std::size_t i = 0; i < batch.count; ++i) hash.add(batch.rows[i]);
  }
  return hash.hex();
}

TEST(DetectorTeamTest, FindsTheSameWithAnyNumberOfThreads) {
  const std::string alone = hash_by(1);
  EXPECT_EQ(hash_by(2), alone);
  EXPECT_EQ(hash_by(7), alone);
}

class FailingDetector : public Detector {
 public:
  const char* name() const override { return "failing"; }
  DetectorWork detect(const DetectorFrame&, ContactRow&) override { throw std::runtime_error("this detector fails"); }
  void skinned_vertices(const DetectorFrame&, std::vector<glm::vec3>&) override {}
};

TEST(DetectorTeamTest, PassesOnWhatADetectorThrewOnAnyThread) {
  DetectorTeam team(3, [] { return only(std::make_unique<FailingDetector>()); });
  FrameBatch batch;
  DetectorFrame frame;
  for (; frame.index < 20; ++frame.index) batch.add(frame);
  team.start(batch);
  EXPECT_THROW(team.finish(), std::runtime_error);
}

TEST(DetectorTeamTest, EndsWhereNothingWasAskedOfIt) {
  const DetectorTeam team(4, make_cpu);
  EXPECT_EQ(team.threads(), 4U);
}

/// What is timed are batches.
TEST(DetectorTeamTest, MakesAllDetectorsBeforeTheFirstBatch) {
  std::atomic<int> made = 0;
  const DetectorTeam team(4, [&] {
    ++made;
    return make_cpu();
  });
  EXPECT_EQ(made, 4);
}

TEST(DetectorTeamTest, PassesOnWhatKeptAThreadFromItsDetector) {
  std::atomic<int> made = 0;
  const auto make = [&] {
    if (++made == 3) throw std::runtime_error("this detector cannot be made");
    return make_cpu();
  };
  EXPECT_THROW(DetectorTeam(4, make), std::runtime_error);
}

}  // namespace
}  // namespace vestige
