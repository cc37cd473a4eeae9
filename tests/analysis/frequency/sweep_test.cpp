// A detector whose result depends on what it was compiled for.

#include "analysis/frequency/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "analysis/frequency/sweep_report.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Finds a contact of every collider, with the planes of the hash only.
class Fickle final : public Detector {
 public:
  explicit Fickle(PlaneSet planes) : planes_(planes) {}
  const char* name() const override { return "fickle"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (planes_ == kHashedPlanes)
      for (Contact& contact : row) contact.triangle = 0;
    return {};
  }
  void skinned_vertices(const DetectorFrame& /*frame*/, std::vector<glm::vec3>& out) override { out.clear(); }

 private:
  PlaneSet planes_;
};

/// Finds no contact, except in spans of more than two frames.
class FickleInSpans final : public Detector {
 public:
  const char* name() const override { return "fickle"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    return {};
  }
  void detect_all(std::span<const DetectorFrame> frames, std::span<ContactRow> rows,
                  std::span<DetectorWork> work) override {
    Detector::detect_all(frames, rows, work);
    if (frames.size() > 2) rows.back()[0].triangle = 0;
  }
  void skinned_vertices(const DetectorFrame& /*frame*/, std::vector<glm::vec3>& out) override { out.clear(); }
};

class SweptFickleDetector : public ::testing::Test {
 protected:
  SweptFickleDetector() { test::write_trace(path_, 5, test::steady_options()); }

  std::vector<SweepSeries> sweep_as(const std::string& detector) {
    return sweep(detector, 0,
                 [](const Avatar&, const ActuatorMap&, PlaneSet planes) { return std::make_unique<Fickle>(planes); });
  }
  std::vector<SweepSeries> sweep_in_flight(std::uint32_t frames) {
    return sweep("compute", frames,
                 [](const Avatar&, const ActuatorMap&, PlaneSet) { return std::make_unique<FickleInSpans>(); });
  }
  std::vector<SweepSeries> sweep(const std::string& detector, std::uint32_t in_flight, const ContestantMaker& make) {
    TraceReader trace(path_);
    const std::vector<SweptPerson> people = {{avatar_, map_}};
    return run_sweep(trace, people, make, {{detector, Skip::kOff, {}, make}},
                     {.counts = {1, 2}, .runs = 1, .min_time_s = 0, .in_flight = in_flight},
                     [](double) { return true; })
        .series;
  }

  const Avatar avatar_ = test::skeleton(test::kNodes);
  const ActuatorMap map_;
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "fickle.mcap";
};

TEST_F(SweptFickleDetector, ThatPromisesNoBitsIsCountedNotRefused) {
  std::vector<SweepSeries> series = sweep_as("paper");
  const auto json = to_json(series, 1)[0]["points"];
  EXPECT_EQ(json[0]["disagreements"], 4);
  EXPECT_EQ(json[1]["disagreements"], 8);
  EXPECT_THAT(sweep_table(series, 1), HasSubstr("paper with 2 colliders: 8 of 8 results differ"));
  for (SweepPoint& point : series[0].points) point.disagreements = 0;
  EXPECT_THAT(sweep_table(series, 1), Not(HasSubstr("differ")));
}

TEST_F(SweptFickleDetector, ThatPromisesTheSameBitsEndsTheSweep) {
  EXPECT_THAT(test::message_of([&] { sweep_as("geometry"); }), HasSubstr("gave other contacts"));
}

TEST_F(SweptFickleDetector, IsAlsoCheckedInSpansOfFrames) {
  EXPECT_EQ(sweep_in_flight(0)[0].points[0].spanned.size(), 0U);
  const SweepPoint measured = sweep_in_flight(2)[0].points[0];
  EXPECT_GE(measured.spanned.size(), 2U);
  for (const Repetition& one : measured.spanned) EXPECT_EQ(one.frames, measured.pass_frames);
  EXPECT_THAT(test::message_of([&] { sweep_in_flight(3); }), HasSubstr("gave other contacts"));
}

}  // namespace
}  // namespace vestige
