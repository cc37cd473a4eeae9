#include "analysis/claims/claims.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/claims/results.hpp"
#include "tests/support/message_of.hpp"

namespace vestige {
namespace {

using test::gl;
using test::origin;
using test::point;
using test::result;
using test::series;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> texts_of(const std::vector<Result>& run) {
  std::vector<std::string> texts;
  for (const Claim& claim : claims_of(run)) texts.push_back(claim.text);
  return texts;
}

TEST(Claims, QuoteASweepAtThePapersCountsWithInterval) {
  const auto sweep = test::sweep({series("paper", gl("softpipe"), {point(1, 100), point(2, 90), point(40, 50)}),
                                  series("cpu", nullptr, {point(1, 200), point(40, 150)})});
  const auto claims = claims_of({result("sweep.json", sweep)});
  ASSERT_EQ(claims.size(), 2U);
  EXPECT_EQ(claims[0].question, Question::kHowFast);
  EXPECT_EQ(claims[0].topic, "`walk.mcap`, 4998 triangles, osmesa");
  EXPECT_EQ(claims[0].text,
            "`paper` on softpipe (software): 100 Hz (99 to 101) with 1 collider, 50 Hz (49 to 51) with 40");
  EXPECT_EQ(claims[1].text, "`cpu`: 200 Hz (199 to 201) with 1 collider, 150 Hz (149 to 151) with 40");
}

TEST(Claims, QuoteTheLargestCountIfThePapersAreNotMeasured) {
  EXPECT_THAT(texts_of({result("s.json", test::sweep({series("cpu", nullptr, {point(2, 9), point(400, 5)})}))}),
              ElementsAre("`cpu`: 5 Hz (4 to 6) with 400 colliders"));
}

TEST(Claims, SayWhatSkippingBringsInOneSentence) {
  auto off = series("cpu", nullptr, {point(1, 200), point(100, 10)});
  auto on = series("cpu", nullptr, {point(1, 900), point(100, 40)});
  off["skip"] = "off";
  on["skip"] = "on";
  const auto other = series("embree", nullptr, {point(1, 30), point(100, 20)});
  const auto claims = claims_of({result("sweep.json", test::sweep({off, on, other}))});
  ASSERT_EQ(claims.size(), 2U);
  EXPECT_THAT(claims[0].topic, HasSubstr("100 colliders"));
  EXPECT_EQ(claims[0].text, "`cpu`: 10 Hz (9 to 11) without skipping, 40 Hz (39 to 41) with skipping");
  EXPECT_EQ(claims[1].text, "`embree`: 20 Hz (19 to 21)");
}

TEST(Claims, NeverShowASoftwareRenderersFigureAsAGraphicsCards) {
  const auto sweep = test::sweep({series("geometry", gl("llvmpipe (LLVM 15.0.6, 256 bits)"), {point(1, 100)}),
                                  series("geometry", gl("NVIDIA GeForce GTX 285/PCIe/SSE2"), {point(1, 900)})});
  EXPECT_THAT(texts_of({result("sweep.json", sweep)}),
              ElementsAre(HasSubstr("on llvmpipe (software): 100 Hz"),
                          HasSubstr("on NVIDIA GeForce GTX 285/PCIe/SSE2: 900 Hz")));
  nlohmann::json query = origin();
  query.update({{"detector", "geometry"}, {"method", "ccd"}, {"arithmetic", "fp32"}, {"files", {"a.csv"}}});
  query["total"] = {{"queries", 3}, {"false_negatives", 0}, {"false_positives", 1}, {"median_us", 1.5}, {"max_us", 9}};
  EXPECT_THAT(texts_of({result("query.json", query)}),
              ElementsAre(HasSubstr("`geometry` on a renderer that the file does not name answers 3 queries")));
}

TEST(Claims, NameTheSlowestAndTheFastestOfManyRecordings) {
  const auto claims = claims_of(
      {result("a.json", test::record(2)), result("b.json", test::record(5)), result("c.json", test::record(1))});
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].text, "`record` samples and writes 2 to 10 frames/s in 3 recordings");
  EXPECT_THAT(claims[0].files, ElementsAre("b.json", "c.json", "a.json"));
}

TEST(Claims, SayWhatIsNotComplete) {
  nlohmann::json record = test::record(2);
  EXPECT_THAT(texts_of({result("a.json", record)}), ElementsAre(Not(HasSubstr("complete"))));
  record["complete"] = false;
  EXPECT_THAT(texts_of({result("a.json", record)}), ElementsAre(HasSubstr("**(not complete")));
}

TEST(Claims, CountContactsThatDifferApartFromReplaysThatAgree) {
  auto same = test::replay("paper", gl("softpipe"), "a");
  same["verify"] = {{"against", "cpu"}, {"differing", 0}, {"expected", 7}};
  auto differs = same;
  differs["verify"]["differing"] = 2;
  auto of_spheres = differs;
  of_spheres["ignores_radii"] = true;
  const auto texts = texts_of(
      {result("1.json", same), result("2.json", same), result("3.json", differs), result("4.json", of_spheres)});
  const std::string paper = "`paper` on softpipe (software, osmesa)";
  const std::string who = paper + " by `ccd`: ";
  EXPECT_THAT(texts, Contains(who + "0 of 14 contacts differ from those of `cpu` in 2 replays"));
  EXPECT_THAT(texts, Contains(who + "2 of 7 contacts differ from those of `cpu`"));
  EXPECT_THAT(texts, Contains(paper + ", which tests the centres of spheres, by `ccd`: 2 of 7 contacts differ from "
                                      "those of `cpu`"));
}

TEST(Claims, SayWhoWritesTheSameTexture) {
  const auto texts = texts_of({result("1.json", test::replay("cpu", nullptr, "a")),
                               result("2.json", test::replay("geometry", gl("softpipe"), "a")),
                               result("3.json", test::replay("paper", gl("softpipe"), "b"))});
  EXPECT_THAT(texts,
              Contains("`geometry` on softpipe (software, osmesa) and `cpu` write the same texture, bit for bit, "
                       "by `ccd`"));
}

TEST(Claims, CompareVerticesWithTheCpusOnlyIfAShaderSkinnedThem) {
  auto paper = test::replay("paper", gl("softpipe"), "a");
  paper["skinning"]["largest_error_of_height"] = 2e-7;
  auto skipping = test::replay("geometry", gl("softpipe"), "b");
  skipping["skip"] = "on";
  auto newer = skipping;
  newer["skinning"]["identical_to_cpu"] = nullptr;
  EXPECT_THAT(texts_of({result("1.json", paper), result("2.json", skipping), result("3.json", newer)}),
              Contains(HasSubstr("1e-07 on the CPU; 2e-07 on softpipe (software), with the CPU's bits in 5 of 5")));
  skipping["skip"] = "off";
  EXPECT_THAT(texts_of({result("1.json", paper), result("2.json", skipping)}),
              Contains(HasSubstr("2e-07 on softpipe (software), with the CPU's bits in 10 of 10")));
}

TEST(Claims, SumAStressUpAndTakeItsOriginFromTheRunBesideIt) {
  const auto row = [](const char* detector, const char* family, int missed) {
    return nlohmann::json{{"detector", detector}, {"name", family},   {"method", "static"},
                          {"cases", 10},          {"contacts", 5},    {"false_negatives", missed},
                          {"false_positives", 1}, {"wrong_winner", 0}};
  };
  const nlohmann::json stress = {{"families",
                                  {row("cpu", "edge", 0), row("geometry", "edge", 0), row("paper", "edge", 2),
                                   row("cpu", "ulp", 0), row("geometry", "ulp", 0), row("paper", "ulp", 3)}}};
  nlohmann::json run = origin();
  run["gl"] = gl("softpipe");
  EXPECT_THAT(
      texts_of({result("stress.json", with_run(stress, run))}),
      ElementsAre("`geometry` on softpipe (software) and `cpu` by `static`, 20 cases: 0 missed, 2 false, 0 with "
                  "a wrong winner",
                  "`paper` on softpipe (software) by `static`, 20 cases: 5 missed, 2 false, 0 with a wrong "
                  "winner; `ulp` is missed most often (3)"));
}

TEST(Claims, QuoteWhatEachMethodMissesOverAllRates) {
  const auto missed = [](const char* detector, double at_60, double at_1000) {
    return nlohmann::json{
        {"detector", detector},
        {"method", "static"},
        {"points", {{{"rate_hz", 60.0}, {"missed_share", at_60}}, {{"rate_hz", 1000.0}, {"missed_share", at_1000}}}}};
  };
  nlohmann::json accuracy = {{"duration_s", 1.0}};
  accuracy["scenes"] = {{{"colliders", "hug"},
                         {"truth", {{"events", 8}}},
                         {"series", {missed("cpu", 0.125, 0), missed("embree", 0.125, 0)}}}};
  const auto claims = claims_of({result("accuracy.json", with_run(accuracy, origin()))});
  ASSERT_EQ(claims.size(), 2U);
  EXPECT_THAT(claims[0].topic, HasSubstr("at 60 and 1000 Hz"));
  EXPECT_EQ(claims[0].text, "hug, of 8 true contacts: 0.0 to 12.5 % by `static`");
  EXPECT_EQ(claims[1].text,
            "Every detector with the same method misses the same shares: `static` of `cpu` and `embree`");

  accuracy["scenes"][0]["series"][1] = missed("embree", 0.25, 0.25);
  EXPECT_THAT(texts_of({result("accuracy.json", with_run(accuracy, origin()))}),
              ElementsAre("hug, of 8 true contacts: 0.0 to 12.5 % by `static` (`cpu`); 25.0 % by `static` (`embree`)"));
}

TEST(Claims, QuoteTheEventsWrongAtTheRateOfDisplaysAndWhoIsApproximate) {
  const auto share = [](nlohmann::json value, nlohmann::json low, nlohmann::json high) {
    return nlohmann::json{{"value", std::move(value)}, {"low", std::move(low)}, {"high", std::move(high)}};
  };
  const auto series = [](const char* detector, const char* method, bool approximate, const nlohmann::json& wrong) {
    const auto point = [](double rate_hz, const nlohmann::json& wrong_share) {
      return nlohmann::json{{"rate_hz", rate_hz}, {"within_tolerance", {{"wrong_share", wrong_share}}}};
    };
    return nlohmann::json{{"detector", detector},
                          {"method", method},
                          {"approximate", approximate},
                          {"points", {point(60, nullptr), point(90, wrong)}}};
  };
  nlohmann::json accuracy = {{"duration_s", 1.0}, {"tolerance_ms", 35.0}};
  accuracy["scenes"] = {
      {{"colliders", "hug"},
       {"truth", {{"events", 2100}}},
       {"series",
        {series("boxes", "carried", true, share(0.621, 0.55, 0.7)), series("cpu", "ccd", false, share(0, 0, 0.0014)),
         series("geometry", "ccd", false, share(0, 0, 0.0014)),
         series("paper", "static", false, share(0.1, nullptr, nullptr))}}}};
  nlohmann::json run = origin();
  run["gl"] = gl("softpipe");
  const auto claims = claims_of({result("accuracy.json", with_run(accuracy, run))});
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_THAT(claims[0].topic, HasSubstr("at 90 Hz, within 35 ms"));
  EXPECT_EQ(
      claims[0].text,
      "hug, 2100 true contacts: `geometry` on softpipe (software) and `cpu` by `ccd`: < 0.14; `paper` on softpipe "
      "(software) by `static`: 10.0; `boxes` (approximate) by `carried`: 62.1 (55.0 to 70.0)");
}

TEST(Claims, SumAgreementUpOverFiles) {
  nlohmann::json agreement = origin();
  agreement["method"] = "ccd";
  agreement["families"] = {{"edge", {{"pairs", 1'000'000}, {"differences", 0}}},
                           {"vertex", {{"pairs", 2'000'000}, {"differences", 1}}}};
  const auto claims = claims_of({result("a-4.json", agreement), result("a-5.json", agreement)});
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_THAT(claims[0].text, HasSubstr("in 2 of 6 million pairs by `ccd`"));
  EXPECT_THAT(claims[0].files, ElementsAre("a-4.json", "a-5.json"));
}

TEST(Claims, SayHowAFrameGrowsAndWhoOvertakesWhom) {
  nlohmann::json growth = origin();
  growth["avatar"] = {{"triangles", 10}};
  growth["colliders"] = 7;
  growth["by_colliders"]["series"] = {series("paper", gl("softpipe"), {point(1, 1e6), point(9, 1e3)}),
                                      series("cpu", nullptr, {point(1, 1e5), point(9, 1e5)})};
  growth["by_triangles"] = {
      {{"triangles", 10}, {"series", nlohmann::json::array({series("cpu", nullptr, {point(7, 1e5)})})}},
      {{"triangles", 40}, {"series", nlohmann::json::array({series("cpu", nullptr, {point(7, 0.5)})})}}};
  growth["crossovers"]["colliders"] = {{{"at", 3.25}, {"cheaper_below", "paper, osmesa"}, {"cheaper_above", "cpu"}}};
  EXPECT_THAT(
      texts_of({result("growth.json", growth)}),
      ElementsAre("`paper` on softpipe (software): 1.00 µs with 1 and 1.00 ms with 9 colliders",
                  "`cpu`: 10.0 µs with 1 and 10.0 µs with 9 colliders; 10.0 µs with 10 and 2.00 s with 40 triangles",
                  "Crossovers: above 3.25 colliders `cpu` is faster than `paper` on softpipe (software)"));
}

TEST(Claims, AreNotMadeOfOtherJson) {
  EXPECT_TRUE(claims_of({result("a.json", nlohmann::json::array()), result("b.json", origin())}).empty());
}

TEST(Claims, NameTheFileThatLacksAField) {
  nlohmann::json record = test::record(1);
  record.erase("frames");
  EXPECT_THAT(test::message_of([&] { claims_of({result("a.json", record)}); }),
              HasSubstr("/results/a.json: is not a result of Vestige"));
}

}  // namespace
}  // namespace vestige
