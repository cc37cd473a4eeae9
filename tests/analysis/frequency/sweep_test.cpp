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

class SweptFickleDetector : public ::testing::Test {
 protected:
  SweptFickleDetector() { test::write_trace(path_, 5, test::steady_options()); }

  std::vector<SweepSeries> sweep_as(const std::string& detector) {
    TraceReader trace(path_);
    const ContestantMaker make = [](const Avatar&, const ActuatorMap&, PlaneSet planes) {
      return std::make_unique<Fickle>(planes);
    };
    const std::vector<SweptPerson> people = {{avatar_, map_}};
    return run_sweep(trace, people, make, {{detector, Skip::kOff, {}, make}},
                     {.counts = {1, 2}, .runs = 1, .min_time_s = 0}, [](double) { return true; })
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

}  // namespace
}  // namespace vestige
