// Query files are foreign bytes: what is read of them, and how they are refused.

#include "analysis/stress/query_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/query_text.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using test::kFalls;
using test::kFallsAsSegment;
using test::kSegmentHeader;
using test::parse;
using test::replaced;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
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
  const QueryFile file = parse(kSegmentHeader + kFallsAsSegment);
  ASSERT_EQ(file.queries.size(), 1U);
  EXPECT_EQ(file.kind, QueryKind::kSegmentTriangle);
  EXPECT_EQ(file.queries[0].line, 2U);
  EXPECT_EQ(file.queries[0].way.end, glm::dvec3(1, 1, -1));
  EXPECT_EQ(file.queries[0].before.b, file.queries[0].after.b);
}

TEST(QueryFile, MayComeFromWindowsAndWithoutALastNewline) {
  for (std::string text : {kFalls, kSegmentHeader + kFallsAsSegment}) {
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
  EXPECT_THAT(error_of(kSegmentHeader), HasSubstr("q.csv: holds no query"));
  EXPECT_THAT(error_of(replaced(kFalls, "1,", "x,")), HasSubstr("q.csv, line 1: 'x' is not a whole number"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0.5,1")), HasSubstr("line 3: '0.5' is not a whole number"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0")), HasSubstr("q.csv, line 3: "));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,1,0,1,7")), HasSubstr("q.csv, line 3: "));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", "4,0,0,1")), HasSubstr("line 3: the denominator of x is 0"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1,0,1,1", "4,1,0,1,0,1,2")), HasSubstr("line 3: the truth"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1,0,1,1", "4,1,0,1,0,1,0")), HasSubstr("two truths"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", std::string(400, '9') + ",1,0,1")),
              HasSubstr("line 3: a coordinate is beyond the largest double"));
  EXPECT_THAT(error_of(replaced(kFalls, "4,1,0,1", std::string(90000, '9') + ",1,0,1")),
              HasSubstr("line 3: a number has 90000 digits"));
  EXPECT_THAT(error_of(kFalls + "1,1,1,1,1,1,1\n"),
              AllOf(HasSubstr("q.csv, line 9: "), HasSubstr("after 1 of 8 rows")));
  EXPECT_THAT(error_of(kSegmentHeader + replaced(kFallsAsSegment, "0x1p+2", "inf")), HasSubstr("q.csv, line 2: 'inf'"));
  EXPECT_THAT(error_of(kSegmentHeader + replaced(kFallsAsSegment, "0x1p+2", "0x1p+2000")), HasSubstr("line 2: "));
  EXPECT_THAT(error_of(kSegmentHeader + replaced(kFallsAsSegment, "0x1p+2,", "")),
              HasSubstr("line 2: is not 19 fields"));
}

}  // namespace
}  // namespace vestige
