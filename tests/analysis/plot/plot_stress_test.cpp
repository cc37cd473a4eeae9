// Draws what 'vestige stress' writes.

#include <gmock/gmock.h>

#include "tests/analysis/plot/plot_fixture.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string entry(const std::string& detector, const std::string& magnitude, int missed) {
  return fmt::format(
      R"({{"name": "edge", "variant": "", "magnitude": {}, "detector": "{}", "method": "static", "cases": 1000,
          "false_negatives": {}, "false_positives": 0, "wrong_winner": 0, "wrong_triangle": 0, "wrong_actuator": 0}})",
      magnitude, detector, missed);
}

class StressFigure : public test::PlotTest {
 protected:
  void write_stress(const std::string& families) const {
    std::filesystem::create_directory(folder_ / "s");
    test::write_text(folder_ / "s" / "stress.json", R"({"families": [)" + families + "]}");
  }
};

TEST_F(StressFigure, ShowsEveryDetectorsErrorsByFamilyAndMagnitude) {
  write_stress(entry("paper", "10", 371) + "," + entry("cpu", "10", 0) + "," + entry("paper", "1e7", 998));
  test::write_text(folder_ / "s" / "run.json",
                   R"({"commit": "0123456789abcdef", "machine": {"processor": "Abacus", "cores": 2}})");
  ASSERT_EQ(run("stress s").exit_code, 0);
  const std::string words = test::words_of(folder_ / "s" / "stress.svg");
  EXPECT_THAT(words, AllOf(HasSubstr("paper"), HasSubstr("cpu"), HasSubstr("edge"), HasSubstr("1e+07"),
                           HasSubstr("371"), HasSubstr("998"), HasSubstr("Abacus"), HasSubstr("0123456789")));
  EXPECT_GT(test::read_png(folder_ / "s" / "stress.png").width, 1000U);
}

TEST_F(StressFigure, NamesTheFieldThatItCannotRead) {
  write_stress(entry("paper", "10", 371) + R"(, {"name": "edge", "variant": "", "magnitude": "far"})");
  const test::Outcome outcome = run("stress s");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("stress.json"), HasSubstr("families[1].magnitude")));
  write_stress(entry("paper", "10", 1001));
  EXPECT_THAT(run("stress s").standard_error, HasSubstr("families[0].false_negatives"));
  EXPECT_EQ(run("stress nowhere").exit_code, 1);
}

}  // namespace
}  // namespace vestige
