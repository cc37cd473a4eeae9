// The page about a batch: runs vestige-plot as a user does, on small folders such as 'vestige batch' writes.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/analysis/box_avatar.hpp"
#include "tests/support/process.hpp"
#include "traces/base/sha256.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHeader = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s\n";

nlohmann::json estimate(double mean, double low, double high, int traces) {
  return {{"mean", mean}, {"low", low}, {"high", high}, {"n", traces}};
}

nlohmann::json metric(const char* name, const char* unit, bool model_based) {
  return {{"name", name},         {"unit", unit},
          {"better", "lower"},    {"model_based", model_based},
          {"formula", "Σ A < B"}, {"source", "van Erp 2005"}};
}

/// One map and law on `traces` traces, whose error is `error_mm`.
nlohmann::json candidate(int rank, const std::string& map, const std::string& law, double error_mm, bool is_worse,
                         int traces) {
  nlohmann::json one = {{"rank", rank}, {"map", map}, {"law", law}, {"traces", traces}};
  one["headline"] = estimate(error_mm, error_mm - 1, error_mm + 1, traces);
  one["difference_from_best"] = estimate(rank, is_worse ? 0.5 : -0.5, rank + 1, traces);
  one["distinguishable_from_best"] = is_worse;
  one["metrics"] = {{"localisation_error_mm", one["headline"]},
                    {"information_bits", estimate(1.5, 1.25, 1.75, traces)},
                    {"coverage", estimate(0.625, 0.5, 0.75, traces)}};
  return one;
}

/// A batch of the box of box_avatar.hpp: map `box`, whose chest, belly and spine fire. Triangles 0 and 1 are the front,
/// 4 and up never fire.
class ReportTest : public test::PlotTest {
 protected:
  ReportTest() {
    test::write_box(folder_.path());
    test::write_box_map(folder_.path());
    for (const char* name : {"batch", "batch/maps", "batch/contacts"})
      std::filesystem::create_directory(folder_ / name);
    EXPECT_EQ(test::run("vestige avatar box.gltf -q -o batch/avatar.glb", folder_.path()).exit_code, 0);
    add_map("box");
    run_["argv"] = {"vestige", "batch", "--maps", "box", "-o", "it's here"};
    run_["commit"] = "0123456789abcdef";
    run_["time"] = "2026-11-22T11:00:00Z";
    run_["machine"] = {{"processor", "Abacus"}, {"cores", 2}};
    run_["batch"] = {
        {"avatar", {{"given", "box.gltf"}}}, {"laws", {"binary", "phantom"}}, {"options", {{"hold_ms", 60}}}};
    run_["complete"] = true;
    run_["failures"] = nlohmann::json::array();
    run_["traces"] = nlohmann::json::array();
    ranking_["rank_by"] = "localisation_error_mm";
    ranking_["interval"] = "95 %, paired bootstrap";
    ranking_["metrics"] = {metric("localisation_error_mm", "mm", false), metric("information_bits", "bits", true),
                           metric("coverage", "", false)};
    ranking_["ranking"] = {candidate(1, "box", "phantom", 12.5, false, 2), candidate(2, "box", "binary", 20, true, 2)};
    add_trace("one", "0,0,,,,,,,,,\n1,0.1,3,0,0.5,0.2,0.3,0.25,0.75,1,0.5\n2,0.2,3,5,0.5,0.2,0.3,0.875,0.5,1,0.5\n");
    add_trace("two", "0,0,,,,,,,,,\n1,0.1,3,1,0.5,0.2,0.3,0.25,0.25,-1,0.5\n");
  }

  void add_map(const std::string& name) const {
    std::filesystem::copy_file(folder_ / "box.png", folder_ / ("batch/maps/" + name + ".png"));
    std::filesystem::copy_file(folder_ / "box.json", folder_ / ("batch/maps/" + name + ".json"));
  }

  void add_trace(const std::string& name, const std::string& rows) {
    test::write_text(folder_ / ("batch/contacts/" + name + ".csv"), kHeader + rows);
    run_["traces"].push_back(
        {{"name", name}, {"given", name + ".mcap"}, {"frames", 3}, {"colliders", 4}, {"contacts", 2}});
  }

  /// Writes the results and draws them.
  test::Outcome report(const std::string& flags = "") const {
    test::write_text(folder_ / "batch/ranking.json", ranking_.dump());
    test::write_text(folder_ / "batch/run.json", run_.dump());
    return run("report batch " + flags);
  }
  std::string page() const { return read_text_file(folder_ / "batch/report.html"); }

  /// Whether nothing of a report is there.
  void expect_nothing_written() const {
    EXPECT_FALSE(std::filesystem::exists(folder_ / "batch/report.html"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "batch/figures"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "batch"))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }

  nlohmann::json ranking_;
  nlohmann::json run_;
};

TEST_F(ReportTest, SaysWhatCameFirstHowSurelyAndFromWhere) {
  const test::Outcome outcome = report();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(page(), AllOf(HasSubstr("The other combination of map and law is worse"), HasSubstr("van Erp 2005"),
                            HasSubstr("Abacus"), HasSubstr("0123456789"), HasSubstr("2026-11-22T11:00:00Z")));
  EXPECT_THAT(page(), HasSubstr("vestige batch --maps box -o &#39;it&#39;\\&#39;&#39;s here&#39;"));
  EXPECT_THAT(page(), HasSubstr("On skin with an actuator: 66.7"))
      << "two of three contacts are on skin with an actuator";
}

TEST_F(ReportTest, BeginsWithASentenceThatAPaperCanQuote) {
  ranking_["metrics"][0]["model_based"] = true;
  run_["batch"]["traces"] = {{{"name", "one"}, {"given", "slide"}, {"seed", 1}},
                             {{"name", "two"}, {"given", "slide"}, {"seed", 2}}};
  for (nlohmann::json& trace : run_["traces"]) trace["given"] = "slide";
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(
      page(),
      HasSubstr("<p class=\"lead\">Over 1 scenario (slide; seeds 1 and 2), <strong>box with phantom</strong> had "
                "the lowest modelled localisation error of 2 combinations of 1 map (box) and 2 intensity laws "
                "(binary and phantom): 12.5\u00a0mm on average over this scenario (95\u00a0% interval 11.5 to "
                "13.5\u00a0mm); on average it let 62.5\u00a0% of a trace's contacts be felt.</p>"));
  run_["batch"].erase("traces");
  ASSERT_EQ(report("--force").exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("Over 2 recorded files (one and two), <strong>box"));
}

TEST_F(ReportTest, SaysWhatWouldChangeTheResult) {
  ranking_["ranking"][1]["difference_from_best"]["p"] = 0.004;
  ranking_["ranking"][1]["difference_from_best"]["p_holm"] = 0.0081;
  nlohmann::json other = {candidate(1, "box", "binary", 10, false, 1), candidate(2, "box", "phantom", 11, true, 1)};
  ranking_["by_scenario"] = {{{"scenario", "slide"}, {"traces", 1}, {"ranking", other}},
                             {{"scenario", "files"}, {"traces", 1}, {"ranking", ranking_["ranking"]}}};
  ranking_["reversals"] = "on slide alone, binary is first";
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(), AllOf(HasSubstr("The next, box with binary, is 2.00\u00a0mm behind (95\u00a0% interval 0.500 to "
                                      "3.00; p 0.004, by Holm's correction 0.0081). More of the same kind would "
                                      "hardly change"),
                            HasSubstr("not on 1 of the 2 scenarios alone; it is distinguishably behind on 1 of them"),
                            HasSubstr("On slide alone, binary is first."), HasSubstr("judges with them"),
                            HasSubstr("best mean by every other metric (2)")));
  ranking_["ranking"][1]["distinguishable_from_best"] = false;
  ranking_["ranking"][1]["difference_from_best"] = estimate(1, 0, 3, 2);
  ASSERT_EQ(report("--force").exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("may put another first. If the difference is as large as it looks, about 4 times"));
}

TEST_F(ReportTest, ListsTheResultsOfEachTrace) {
  nlohmann::json scores = nlohmann::json::array();
  for (const char* trace : {"one", "two"})
    for (const char* law : {"binary", "phantom"})
      scores.push_back({{"map", "box"}, {"trace", trace}, {"law", law}, {"values", {{"localisation_error_mm", 43.2}}}});
  scores.back()["values"]["localisation_error_mm"] = nullptr;
  test::write_text(folder_ / "batch/scores.json", nlohmann::json{{"scores", scores}}.dump());
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(), AllOf(HasSubstr("<th scope=\"row\" class=\"name\">one</th><td class=\"n\">43.2</td>"),
                            HasSubstr("<th scope=\"row\" class=\"name\">two</th><td class=\"n\">–</td>")));
  scores[0]["trace"] = "three";
  test::write_text(folder_ / "batch/scores.json", nlohmann::json{{"scores", scores}}.dump());
  EXPECT_THAT(report("--force").standard_error, AllOf(HasSubstr("scores.json"), HasSubstr("no trace of run.json")));
}

TEST_F(ReportTest, NeedsNothingOutsideItself) {
  ASSERT_EQ(report().exit_code, 0);
  std::string text = page();
  for (const char* not_there : {"<script", "<link", "<iframe", "@import", " src=", "javascript:"})
    EXPECT_THAT(text, Not(HasSubstr(not_there)));
  for (std::size_t at = text.find("href=\""); at != std::string::npos; at = text.find("href=\"", at + 1)) {
    const std::string target = text.substr(at + 6, 10);
    EXPECT_TRUE(target.starts_with("#") || target.starts_with("data:image")) << target;
  }
  for (std::size_t at = text.find("url("); at != std::string::npos; at = text.find("url(", at + 1))
    EXPECT_EQ(text[at + 4], '#');
}

TEST_F(ReportTest, NoNameBecomesMarkup) {
  test::write_text(folder_ / "batch/maps/box.json",
                   R"({"actuators": [{"grey": 10, "name": "<b>left & \"right\"</b>"}, {"grey": 20, "name": "it's"},
                       {"grey": 30, "name": "spine"}]})");
  run_["failures"] = {{{"what", "trace"},
                       {"name", "<script>alert(1)</script>"},
                       {"given", "a\"b.mcap"},
                       {"cause", "is no trace"},
                       {"remedy", "record <it> again"}}};
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(), AllOf(Not(HasSubstr("<b>")), Not(HasSubstr("<script>")), Not(HasSubstr("<it>")),
                            HasSubstr("&lt;b&gt;left &amp; &quot;right&quot;&lt;/b&gt;"), HasSubstr("it&#39;s"),
                            HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;"), HasSubstr("a&quot;b.mcap"),
                            HasSubstr("1 input could not be used")));
  test::words_of(folder_ / "batch/figures/box-timeline-phantom.svg");
}

TEST_F(ReportTest, RepeatsWhatTheBatchWarnedOf) {
  run_["maps"] = {{{"name", "box"}, {"warnings", {"box: its halves share a texture"}}}};
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("box: its halves share a texture"));
  run_["maps"] = {{{"name", "box"}}};
  const test::Outcome outcome = report("--force");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("run.json"), HasSubstr("maps[0].warnings")));
}

TEST_F(ReportTest, MarksWhatIsAModel) {
  ranking_["rank_by"] = "information_bits";
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("model, not a user study"), HasSubstr("Information is a model, not a user study")));
  ranking_["metrics"][1]["model_based"] = false;
  ASSERT_EQ(report("--force").exit_code, 0);
  EXPECT_THAT(page(), Not(HasSubstr("model, not a user study")));
}

TEST_F(ReportTest, WritesItsFiguresAsSvgAndPng) {
  ASSERT_EQ(report().exit_code, 0);
  for (const char* name : {"ranking", "box-regions", "box-contacts", "box-not-felt", "box-errors",
                           "box-timeline-phantom", "box-timeline-binary"}) {
    const std::string stem = std::string("batch/figures/") + name;
    test::words_of(folder_ / (stem + ".svg"));
    EXPECT_GT(test::read_png(folder_ / (stem + ".png")).width, 400U) << name;
  }
  EXPECT_THAT(test::words_of(folder_ / "batch/figures/ranking.svg"), HasSubstr("box, phantom"));
}

TEST_F(ReportTest, EqualFoldersGiveEqualBytes) {
  ASSERT_EQ(report("-o a").exit_code, 0);
  ASSERT_EQ(report("-o b").exit_code, 0);
  EXPECT_EQ(test::run("diff -r a b", folder_.path()).exit_code, 0);
}

TEST_F(ReportTest, OneTraceHasNoInterval) {
  run_["traces"].erase(1);
  run_["traces"][0]["frames"] = 1;
  run_["traces"][0]["contacts"] = 1;
  ranking_["ranking"] = {candidate(1, "box", "phantom", 12.5, false, 1), candidate(2, "box", "binary", 20, false, 1)};
  for (nlohmann::json& one : ranking_["ranking"])
    for (const char* end : {"low", "high"}) one["headline"][end] = nullptr;
  ranking_["interval"] = nullptr;
  ranking_["why_no_intervals"] = "there is only 1 file";
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("12.5\u00a0mm (one trace)"), HasSubstr("no intervals: there is only 1 file"),
                    HasSubstr("over 1 trace (1 frame, 1 contact), by the mean"), Not(HasSubstr("class=\"level\""))));
}

TEST_F(ReportTest, MapsAndTracesWithoutAContactAreShown) {
  for (const char* name : {"one", "two"})
    test::write_text(folder_ / "batch/contacts" / (std::string(name) + ".csv"),
                     std::string(kHeader) + "0,0,,,,,,,,,\n");
  for (nlohmann::json& one : ranking_["ranking"]) {
    one["rank"] = nullptr;
    for (const char* value : {"mean", "low", "high"}) one["headline"][value] = nullptr;
  }
  const test::Outcome outcome = report();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(page(), AllOf(HasSubstr("nothing is ranked"), HasSubstr("No trace has a contact")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "batch/figures/ranking.svg"));
}

TEST_F(ReportTest, OfAHundredMapsTheBestHavePictures) {
  ranking_["ranking"].clear();
  for (int i = 1; i <= 100; ++i) {
    const std::string map = fmt::format("map{}", i);
    add_map(map);
    ranking_["ranking"].push_back(candidate(i, map, "binary", i, i > 1, 2));
  }
  ASSERT_EQ(report("--top 2").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "batch/figures/map2-regions.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "batch/figures/map3-regions.png"));
  EXPECT_THAT(page(), AllOf(HasSubstr("98 maps more"), HasSubstr(">map100<")));
}

TEST_F(ReportTest, WhatIsThereStaysUnlessForced) {
  ASSERT_EQ(report().exit_code, 0);
  const std::string before = page();
  run_["commit"] = "fedcba9876543210";
  const test::Outcome refused = report();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, AllOf(HasSubstr("report.html"), HasSubstr("--force")));
  EXPECT_EQ(page(), before);
  ASSERT_EQ(report("--force").exit_code, 0);
  EXPECT_THAT(page(), HasSubstr("fedcba9876"));
}

TEST_F(ReportTest, FiguresOfMapsThatItNoLongerDrawsAreGone) {
  add_map("other");
  ranking_["ranking"] = {candidate(1, "box", "phantom", 12.5, false, 2), candidate(2, "other", "binary", 20, true, 2)};
  ASSERT_EQ(report().exit_code, 0);
  const std::filesystem::path figures = folder_ / "batch/figures";
  for (const char* mine : {"other-notes.svg", "third-regions.svg"}) test::write_text(figures / mine, "mine");
  const std::vector<std::string> kinds = {"regions", "contacts", "not-felt", "errors", "timeline-binary"};
  for (const std::string& kind : kinds) ASSERT_TRUE(std::filesystem::exists(figures / ("other-" + kind + ".png")));
  ASSERT_EQ(report("--top 1 --force").exit_code, 0);
  for (const std::string& kind : kinds)
    for (const char* extension : {".svg", ".png"}) {
      EXPECT_FALSE(std::filesystem::exists(figures / ("other-" + kind + extension))) << kind << extension;
      EXPECT_TRUE(std::filesystem::exists(figures / ("box-" + kind + extension))) << kind << extension;
    }
  for (const char* mine : {"other-notes.svg", "third-regions.svg", "ranking.svg"})
    EXPECT_TRUE(std::filesystem::exists(figures / mine)) << mine;
}

TEST_F(ReportTest, SaysThatContactsAreApproximate) {
  run_["batch"]["options"]["detector"] = "boxes";
  run_["batch"]["options"]["approximate"] = true;
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(page(), AllOf(HasSubstr("with the approximate detector boxes, <strong>box with phantom</strong> had the"),
                            HasSubstr("There is no page on which it moves: the batch&#39;s detector puts simpler")));
  for (nlohmann::json& trace : run_["traces"]) trace["contacts"] = 0;
  for (nlohmann::json& one : ranking_["ranking"]) {
    one["rank"] = nullptr;
    for (const char* value : {"mean", "low", "high"}) one["headline"][value] = nullptr;
  }
  ASSERT_EQ(report("--force").exit_code, 0);
  EXPECT_THAT(page(), AllOf(HasSubstr("With the approximate detector boxes, no combination of map and law has a value"),
                            HasSubstr("There is no page on which it moves: the batch&#39;s detector puts simpler")));
}

TEST_F(ReportTest, RefusesAnAvatarMapOrMotorsOtherThanTheJudged) {
  const std::string sidecar = read_text_file(folder_ / "batch/maps/box.json");
  const std::string map = read_text_file(folder_ / "batch/maps/box.png") + sidecar;
  const std::string avatar = read_text_file(folder_ / "batch/avatar.glb");
  const auto sha256 = [](const std::string& bytes) { return sha256_hex(std::as_bytes(std::span(bytes))); };
  const std::string other = sha256("other");
  run_["batch"]["maps"] = {{{"name", "box"}, {"given", "box.png"}, {"sha256", other}}};
  EXPECT_THAT(report().standard_error,
              AllOf(HasSubstr("box.png"), HasSubstr("was changed after"), HasSubstr("run the same 'vestige batch'")));
  run_["batch"]["maps"][0]["sha256"] = sha256(map);
  run_["batch"]["avatar"]["sha256"] = other;
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("avatar.glb"), HasSubstr("was changed after")));
  run_["batch"]["avatar"]["sha256"] = sha256(avatar);
  test::write_text(folder_ / "batch/avatar.glb", avatar.substr(0, avatar.size() / 2));
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("avatar.glb"), HasSubstr("was changed after"),
                                             HasSubstr("run the same 'vestige batch'")));
  test::write_text(folder_ / "batch/avatar.glb", avatar);
  test::write_text(folder_ / "batch/maps/box.json", sidecar + "\n");
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("box.png or its sidecar"), HasSubstr("was changed after")));
  test::write_text(folder_ / "batch/maps/box.json", sidecar);
  const std::string motors = R"({"rise_ms": 400})";
  run_["batch"]["options"]["actuator"] = {{"given", "slow.json"}, {"sha256", sha256(motors)}};
  test::write_text(folder_ / "batch/actuator.json", R"({"rise_ms": 300})");
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("actuator.json"), HasSubstr("was changed after")));
  test::write_text(folder_ / "batch/actuator.json", motors);
  expect_nothing_written();
  EXPECT_EQ(report().exit_code, 0);
}

TEST_F(ReportTest, SaysWhatWritesAMissingFileAgain) {
  test::write_text(folder_ / "batch/ranking.json", ranking_.dump());
  test::write_text(folder_ / "batch/run.json", run_.dump());
  for (const std::string name : {"avatar.glb", "maps/box.png", "contacts/two.csv", "run.json"}) {
    std::filesystem::rename(folder_ / "batch" / name, folder_ / "aside");
    const test::Outcome outcome = run("report batch");
    EXPECT_EQ(outcome.exit_code, 1) << name;
    const char* how = name == "run.json" ? " with --force: it writes the file" : ": it writes the file";
    EXPECT_THAT(
        outcome.standard_error,
        HasSubstr("batch/" + name + ": is missing\n  run the same 'vestige batch' (or 'batch merge') again" + how));
    std::filesystem::rename(folder_ / "aside", folder_ / "batch" / name);
  }
  expect_nothing_written();
}

TEST_F(ReportTest, NamesWhatIsWrongWithAFolderAndWritesNothing) {
  EXPECT_THAT(run("report nowhere").standard_error, AllOf(HasSubstr("nowhere"), HasSubstr("vestige batch")));
  EXPECT_THAT(run("report batch").standard_error, AllOf(HasSubstr("ranking.json"), HasSubstr("run 'vestige batch")));
  test::write_text(folder_ / "batch/run.json", run_.dump());
  EXPECT_THAT(run("report batch").standard_error, HasSubstr("run.json says what failed"));

  std::filesystem::create_directory(folder_ / "measured");
  test::write_text(folder_ / "measured/accuracy.json", "{}");
  EXPECT_THAT(run("report measured").standard_error, HasSubstr("is of 'vestige accuracy', which ranks no maps"));

  const nlohmann::json good = ranking_;
  ranking_["ranking"][1]["headline"]["mean"] = "far";
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("ranking.json"), HasSubstr("ranking[1].headline.mean")));
  ranking_ = good;
  ranking_["ranking"][1].erase("law");
  EXPECT_THAT(report().standard_error, HasSubstr("ranking[1].law is missing"));
  ranking_ = good;
  ranking_["ranking"][0]["map"] = "../../box";
  EXPECT_THAT(report().standard_error, HasSubstr("ranking[0].map"));
  ranking_ = good;
  ranking_["ranking"][0]["map"] = "gone";
  EXPECT_THAT(report().standard_error, HasSubstr("gone.png"));
  ranking_ = good;
  test::write_text(folder_ / "batch/contacts/two.csv",
                   std::string(kHeader) + "0,0,,,,,,,,,\n1,0.1,3,99,0.5,0.2,0.3,0,0,1,0\n");
  EXPECT_THAT(report().standard_error,
              AllOf(HasSubstr("two.csv"), HasSubstr("triangle 99"), HasSubstr("run the same 'vestige batch'")));
  test::write_text(folder_ / "batch/contacts/two.csv",
                   std::string(kHeader) + "0,0,,,,,,,,,\n1,0.1,3,1,0.5,7,0.3,0,0,1,0\n");
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("two.csv"), HasSubstr("u and v")));
  test::write_text(folder_ / "batch/contacts/two.csv", "0,0,torn");
  EXPECT_THAT(report().standard_error, AllOf(HasSubstr("two.csv"), HasSubstr("run the same 'vestige batch'")));
  std::filesystem::remove(folder_ / "batch/contacts/two.csv");
  EXPECT_THAT(report().standard_error,
              AllOf(HasSubstr("two.csv"), HasSubstr("missing"), HasSubstr("run the same 'vestige batch'")));
  run_["complete"] = false;
  run_.erase("traces");
  EXPECT_THAT(report().standard_error,
              AllOf(HasSubstr("run.json"), HasSubstr("not finished"), HasSubstr("run the same 'vestige batch' again")));
  expect_nothing_written();
}

}  // namespace
}  // namespace vestige
