// Queries with known truth: what is read of their files, and what is counted.

#include "analysis/query.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/test_data.hpp"
#include "traces/error.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kHeader = "source,query,gt,float_exact,px,py,pz,qx,qy,qz,ax,ay,az,bx,by,bz,cx,cy,cz\n";

/// A point falls from z = 1 to z = -1 through a triangle at rest.
const std::string kFalls =
    "1,1,1,1,1,1,1\n0,1,0,1,0,1,1\n4,1,0,1,0,1,1\n0,1,4,1,0,1,1\n"
    "1,1,1,1,-1,1,1\n0,1,0,1,0,1,1\n4,1,0,1,0,1,1\n0,1,4,1,0,1,1\n";

const std::string kFallsAsSegment =
    "falls,0,1,1,0x1p+0,0x1p+0,0x1p+0,0x1p+0,0x1p+0,-0x1p+0,0x0p+0,0x0p+0,0x0p+0,0x1p+2,0x0p+0,0x0p+0,0x0p+0,0x1p+2,"
    "0x0p+0\n";

QueryFile parse(const std::string& text, Inexact inexact = Inexact::kRefuse) {
  return parse_queries(text, "q.csv", inexact);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

QueryScore score(const QueryFile& file, Method method, QueryTruth truth, const QueryResponder& responder) {
  return answer_queries(file, method, truth, responder, [](double) { return true; });
}

QueryResponder detector(Method method, decltype(&make_cpu_detector) make) {
  return whole_detector([=](const Avatar& avatar, const ActuatorMap& map) {
    return make(avatar, map, {Surface::kAll, PlaneSet(), method});
  });
}

TEST(QueryFile, HoldsEightRowsAQuery) {
  const QueryFile file = parse(kFalls + kFalls);
  ASSERT_EQ(file.queries.size(), 2U);
  EXPECT_EQ(file.kind, QueryKind::kPointTriangle);
  const Query& query = file.queries[1];
  EXPECT_EQ(query.line, 9U);
  EXPECT_TRUE(query.truth);
  EXPECT_EQ(query.way.end, glm::dvec3(1, 1, -1));
  EXPECT_EQ(query.after.c, glm::dvec3(0, 4, 0));
}

TEST(QueryFile, HoldsASegmentAndATriangleARowBehindItsHeader) {
  const QueryFile file = parse(kHeader + kFallsAsSegment);
  ASSERT_EQ(file.queries.size(), 1U);
  EXPECT_EQ(file.kind, QueryKind::kSegmentTriangle);
  EXPECT_EQ(file.queries[0].line, 2U);
  EXPECT_EQ(file.queries[0].way.end, glm::dvec3(1, 1, -1));
  EXPECT_EQ(file.queries[0].before.b, file.queries[0].after.b);
}

TEST(QueryFile, MayComeFromWindowsAndWithoutALastNewline) {
  for (std::string text : {kFalls, kHeader + kFallsAsSegment}) {
    text.pop_back();
    std::string windows = "\xEF\xBB\xBF";
    for (const char letter : text) windows += letter == '\n' ? "\r\n" : std::string(1, letter);
    EXPECT_EQ(parse(windows).queries.size(), 1U);
  }
}

TEST(QueryFile, FractionsAreReadToTheLastBit) {
  const std::string fraction = "1,1,1,1,1,1,1";
  EXPECT_EQ(parse(replaced(kFalls, fraction, "1,1,-6,-4,010,1,1")).queries[0].way.start, glm::dvec3(1, 1.5, 10));
  EXPECT_EQ(parse(replaced(kFalls, fraction,
                           "6004799503160661,18014398509481984,-5393163488364751,2305843009213693952,"
                           "9007199254740993000,1000,1"),
                  Inexact::kRound)
                .queries[0]
                .way.start,
            glm::dvec3(0x1.5555555555555p-2, -5393163488364751 * 0x1p-61, 9007199254740992.0));
}

TEST(QueryFile, RefusesWhatNoDoubleEqualsAndNamesTheWayOut) {
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "1,3,0,1")),
              AllOf(HasSubstr("q.csv, line 3: "), HasSubstr("between two doubles"), HasSubstr("--round-fp32")));
  EXPECT_EQ(parse(replaced(kFalls, "4,1,0,1", "1,3,0,1"), Inexact::kRound).queries[0].before.b.x, 1.0 / 3);
}

TEST(QueryFile, SaysWhereItIsMalformed) {
  EXPECT_THAT(error_of(""), HasSubstr("q.csv: holds no query"));
  EXPECT_THAT(error_of(kHeader), HasSubstr("q.csv: holds no query"));
  EXPECT_THAT(error_of(replaced(kFalls, "1,", "x,")), HasSubstr("q.csv, line 1: is not seven whole numbers"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0.5,1")), HasSubstr("line 3: is not seven whole numbers"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0")), HasSubstr("q.csv, line 3: "));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0,1,7")), HasSubstr("q.csv, line 3: "));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,0,0,1")), HasSubstr("line 3: a denominator is 0"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1,0,1,1", "4,1,0,1,0,1,2")), HasSubstr("line 3: the truth"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1,0,1,1", "4,1,0,1,0,1,0")), HasSubstr("two truths"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", std::string(400, '9') + ",1,0,1")),
              HasSubstr("line 3: a coordinate is beyond the largest double"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", std::string(90000, '9') + ",1,0,1")),
              HasSubstr("line 3: a number has 90000 digits"));
  EXPECT_THAT(error_of(kFalls + "1,1,1,1,1,1,1\n"),
              AllOf(HasSubstr("q.csv, line 9: "), HasSubstr("after 1 of 8 rows")));
  EXPECT_THAT(error_of(kHeader + replaced(kFallsAsSegment, "0x1p+2", "inf")), HasSubstr("q.csv, line 2: 'inf'"));
  EXPECT_THAT(error_of(kHeader + replaced(kFallsAsSegment, "0x1p+2", "0x1p+2000")), HasSubstr("line 2: "));
  EXPECT_THAT(error_of(kHeader + replaced(kFallsAsSegment, "0x1p+2,", "")), HasSubstr("line 2: is not 19 fields"));
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
  const QueryFile file = parse(kHeader + replaced(kFallsAsSegment, "0x1p+2", "0x1p+200"));
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
