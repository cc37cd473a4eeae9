// Queries with known truth: what is counted.

#include "analysis/stress/query.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "detector/detectors/make_detectors.hpp"
#include "tests/support/query_text.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using test::kFalls;
using test::kFallsAsSegment;
using test::kSegmentHeader;
using test::parse;
using test::replaced;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

QueryScore score(const QueryFile& file, Method method, QueryTruth truth, const QueryResponder& responder) {
  return answer_queries(file, method, truth, responder, [](double) { return true; });
}

QueryResponder detector(Method method, decltype(&make_cpu_detector) make) {
  return whole_detector([=](const Avatar& avatar, const ActuatorMap& map) {
    return make(avatar, map, {Surface::kAll, PlaneSet(), method});
  });
}

TEST(QueryScore, CountsFalseAnswersByTheirLines) {
  const QueryFile file = parse(kFalls + kFalls);
  const auto saying = [](bool contact) { return [=](const Query&) { return QueryAnswer{contact, true}; }; };
  const QueryScore missed = score(file, Method::kCcd, QueryTruth::kFile, saying(false));
  EXPECT_THAT(missed.false_negatives, ElementsAre(1, 9));
  EXPECT_THAT(missed.false_positives, ElementsAre());
  EXPECT_EQ(missed.positives, 2U);
  EXPECT_EQ(missed.decided_exactly, 2U);
  EXPECT_FALSE(missed.all_right());
  QueryScore total;
  total.add(missed);
  total.add(score(file, Method::kCcd, QueryTruth::kFile, saying(true)));
  const auto json = to_json(total);
  EXPECT_EQ(json["queries"], 4);
  EXPECT_EQ(json["false_negatives"], 2);
  EXPECT_EQ(json["false_positives"], 0);
  EXPECT_GE(json["max_us"], json["median_us"]);
}

TEST(QueryScore, TakesTheTruthAboutAnotherQuestionFromExactArithmetic) {
  // The triangle comes up to meet the point, which would not reach where it was; at t = 1 the point is far below.
  const std::string rises = replaced(kFalls, "1,1,1,1,1,1,1\n", "1,1,1,1,9,1,1\n");
  const QueryFile file = parse(rises);
  for (const QueryResponder& responder : {deciding_code(Method::kStatic), exact_truth(Method::kStatic)})
    EXPECT_TRUE(score(file, Method::kStatic, QueryTruth::kExact, responder).all_right());
}

TEST(Rounding, RefusesWhatIsBeyondFp32) {
  const QueryFile file = parse(kSegmentHeader + replaced(kFallsAsSegment, "0x1p+2", "0x1p+200"));
  try {
    rounded_to_fp32(file);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("q.csv, line 2: "), HasSubstr("largest fp32")));
  }
}

class PublicQueries : public ::testing::TestWithParam<const char*> {};

TEST_P(PublicQueries, AreAnsweredWithoutAFalseOne) {
  const auto path = test::data(std::filesystem::path("ccd") / GetParam());
  VESTIGE_REQUIRE_DATA(path);
  const QueryFile file = read_query_file(path, Inexact::kRefuse);
  const Method method = file.kind == QueryKind::kSegmentTriangle ? Method::kStatic : Method::kCcd;
  for (const QueryResponder& responder : {deciding_code(method), exact_truth(method)}) {
    const QueryScore as_doubles = score(file, method, QueryTruth::kFile, responder);
    EXPECT_THAT(as_doubles.false_negatives, ElementsAre());
    EXPECT_THAT(as_doubles.false_positives, ElementsAre());
  }
  const QueryFile rounded = rounded_to_fp32(file);
  for (const auto make : {&make_cpu_detector, &make_exact_detector}) {
    const QueryScore as_floats = score(rounded, method, QueryTruth::kExact, detector(method, make));
    EXPECT_EQ(as_floats.queries, file.queries.size());
    EXPECT_THAT(as_floats.false_negatives, ElementsAre());
    EXPECT_THAT(as_floats.false_positives, ElementsAre());
  }
}

INSTANTIATE_TEST_SUITE_P(Files, PublicQueries,
                         ::testing::Values("handcrafted/erleben-cube-cliff-edges/vertex-face/data_0_0.csv",
                                           "handcrafted/erleben-cube-cliff-edges/vertex-face/data_0_1.csv",
                                           "handcrafted/erleben-sliding-spike/vertex-face/data_0_0.csv",
                                           "handcrafted/erleben-sliding-spike/vertex-face/data_0_1.csv",
                                           "handcrafted/erleben-spike-hole/vertex-face/data_0_0.csv",
                                           "handcrafted/erleben-wedges/vertex-face/data_0_0.csv",
                                           "handcrafted/erleben-wedges/vertex-face/data_0_1.csv",
                                           "handcrafted/unit-tests/vertex-face/data_0_0.csv",
                                           "handcrafted/unit-tests/vertex-face/data_0_1.csv",
                                           "simulation/cloth-funnel-227vf.csv", "simulation/rod-twist-3036vf.csv",
                                           "static_segment_triangle.csv"));

}  // namespace
}  // namespace vestige
