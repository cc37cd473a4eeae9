// Live input by lines of JSON.

#include "traces/live/live_ndjson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class LiveLines : public ::testing::Test {
 protected:
  std::vector<TraceFrame> read(std::string_view text, std::size_t piece = 1 << 20, std::int64_t now_ns = 7) {
    lines_ = std::make_unique<LiveNdjson>(avatar_);
    std::vector<TraceFrame> frames;
    const auto take = [&](TraceFrame frame) { frames.push_back(std::move(frame)); };
    for (std::size_t at = 0; at < text.size(); at += piece) lines_->push(text.substr(at, piece), now_ns, take);
    lines_->finish(now_ns, take);
    return frames;
  }

  const Avatar avatar_ = test::skeleton(2);
  std::unique_ptr<LiveNdjson> lines_;
};

constexpr std::string_view kWhole =
    R"({"frame":4,"time_s":0.5,"pose":{"origin":[0.1,-0.0,1e300],"nodes":[[1,2,3,0,0,0,1,1,1,1],)"
    R"([0.1,-0.0,"inf",0.5,0.5,0.5,0.5,"nan",2,3]]},"colliders":[{"id":3,"position":[0.2,1.1,0.4]}],"teleported":[3]})"
    "\n";

TEST_F(LiveLines, AreFramesToTheBit) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, kWhole.size()}) {
    const auto frames = read(kWhole, piece);
    ASSERT_EQ(frames.size(), 1U) << piece;
    const TraceFrame& frame = frames[0];
    EXPECT_EQ(frame.index, 4U);
    EXPECT_EQ(frame.time_ns, 500'000'000);
    EXPECT_TRUE(test::same_bits(frame.poses.front().origin_m, glm::dvec3(0.1, -0.0, 1e300)));
    EXPECT_EQ(frame.poses.front().nodes[1].translation.x, 0.1F);
    EXPECT_TRUE(std::signbit(frame.poses.front().nodes[1].translation.y));
    EXPECT_TRUE(std::isinf(frame.poses.front().nodes[1].translation.z));
    EXPECT_TRUE(std::isnan(frame.poses.front().nodes[1].scale.x));
    ASSERT_EQ(frame.colliders.size(), 1U);
    EXPECT_EQ(frame.colliders[0].id, 3U);
    EXPECT_EQ(frame.colliders[0].position_m.y, 1.1);
    EXPECT_THAT(frame.teleported, ElementsAre(3U));
    EXPECT_EQ(lines_->malformed(), 0U);
  }
}

TEST_F(LiveLines, MayLeaveOutAllButTheBraces) {
  const auto frames = read("{}\r\n\n{\"pose\":{\"joints\":{\"" + std::string("node 1 \\\"\\u00e9\\\"") +
                           "\":{\"t\":[0,5,0]}}}}\n{\"time_s\":1}");
  ASSERT_EQ(frames.size(), 3U) << ::testing::PrintToString(lines_->problems());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(frames[i].index, i);
  EXPECT_EQ(frames[0].time_ns, 7) << "when the line came";
  EXPECT_EQ(frames[0].poses.front().origin_m, glm::dvec3(0));
  EXPECT_EQ(frames[1].poses.front().nodes[1].translation.y, 5.0F);
  EXPECT_EQ(frames[2].poses.front().nodes[1].translation.y, 5.0F) << "as the line before";
  EXPECT_EQ(frames[2].time_ns, 1'000'000'000);
}

TEST_F(LiveLines, FieldsThatMeanNothingAreToldOfOnce) {
  const auto frames = read(R"({"colider": []}
{"colider": [], "pose": {"joint": 1, "joints": {}}}
)");
  EXPECT_THAT(frames, SizeIs(2));
  EXPECT_EQ(lines_->malformed(), 0U);
  EXPECT_THAT(lines_->problems(),
              ElementsAre(AllOf(HasSubstr("line 1"), HasSubstr("'colider'"), HasSubstr("colliders")),
                          AllOf(HasSubstr("line 2"), HasSubstr("'joint'"))));
}

TEST_F(LiveLines, ThatAreWrongAreLeftOutAndCounted) {
  const std::string long_line = std::string(17 << 20, 'x') + "\n";
  const std::vector<std::string> wrong = {
      "nonsense\n",
      "[1,2]\n",
      "{\"frame\":-1}\n",
      "{\"frame\":4294967296}\n",
      "{\"time_s\":-1}\n",
      "{\"time_s\":\"inf\"}\n",
      "{\"time_s\":1e300}\n",
      "{\"time_s\":\"soon\"}\n",
      "{\"pose\":5}\n",
      "{\"pose\":{\"x\":" + std::string(100000, '[') + std::string(100000, ']') + ",\"nodes\":[1e39]}}\n",
      "{\"pose\":{}}\n",
      "{\"pose\":{\"nodes\":[]}}\n",
      "{\"pose\":{\"nodes\":[[1,2],[3]]}}\n",
      "{\"pose\":{\"joints\":{\"nobody\":{}}}}\n",
      "{\"colliders\":5}\n",
      "{\"colliders\":[5]}\n",
      "{\"colliders\":[{\"id\":-1,\"position\":[0,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[1e999,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[NaN,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0]},{\"id\":1,\"position\":[0,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":-1}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":11}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":\"nan\"}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":[1]}]}\n",
      "{\"teleported\":{}}\n",
      "{\"frame\":0}\n",
      "{\"time_s\":0.4}\n",
      long_line,
  };
  for (const std::string& line : wrong) {
    const auto frames = read(std::string(kWhole) + line + "{}\n");
    EXPECT_EQ(frames.size(), 2U) << line.substr(0, 80);
    EXPECT_EQ(lines_->malformed(), 1U) << line.substr(0, 80);
    ASSERT_THAT(lines_->problems(), SizeIs(1));
    EXPECT_THAT(lines_->problems()[0], HasSubstr("line 2: ")) << line.substr(0, 80);
    EXPECT_EQ(frames.back().index, 5U);
  }
}

TEST_F(LiveLines, BehindTheLastNumberAreLeftOut) {
  EXPECT_THAT(read("{\"frame\":4294967295}\n{}\n{}\n"), SizeIs(1));
  EXPECT_EQ(lines_->malformed(), 2U);
}

TEST_F(LiveLines, SayWhereANumberIsMissing) {
  read("{\"time_s\":\"soon\"}\n{\"colliders\":[{\"id\":1,\"position\":[0,null,0]}]}\n");
  EXPECT_THAT(lines_->problems(), ElementsAre("line 1: 'time_s' has string instead of a number",
                                              "line 2: 'position' has null instead of a number"));
}

}  // namespace
}  // namespace vestige
