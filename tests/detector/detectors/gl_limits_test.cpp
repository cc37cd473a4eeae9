// Drivers whose limits are low: nothing is lost, or an error says what does not fit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/captured_pairs.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/gl/limited_context.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/pairs/pile.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::LimitedContext;
using ::testing::HasSubstr;

constexpr GLint kHeadBytes = 8;
constexpr GLint kPairBytes = 8;
const DetectorOptions kCulledByShaders = {.method = Method::kStatic, .skip = Skip::kOn, .culling = Culling::kGpu};

TEST(SmallStorageBlocks, LoseNoPairAndAreNeverExceeded) {
  constexpr GLint kLimit = kHeadBytes + kPairBytes * 12288;
  const Avatar pile = test::pile_of(300);
  const ActuatorMap map;
  const DetectorFrame frame = test::frame_through(pile, 100);
  const auto geometry = make_geometry_detector(LimitedContext::make({{GL_MAX_SHADER_STORAGE_BLOCK_SIZE, kLimit}}), pile,
                                               map, {Surface::kAll, PlaneSet(), Method::kStatic, Skip::kOff});
  ContactRow row;
  for (int i = 0; i < 2; ++i) {  // growing, and grown
    const DetectorWork work = geometry->detect(frame, row);
    EXPECT_EQ(work.pairs_captured, 300U * 100U);
    EXPECT_EQ(work.pairs_meeting, 300U * 100U);
    for (const Contact& contact : row) ASSERT_EQ(contact.triangle, 299U);
  }
  EXPECT_LE(LimitedContext::largest_buffer_bytes(), kLimit);
}

/// Ten meshlets in four rounds.
TEST(SmallTextureBuffers, HoldAFewMeshletsAtATimeAndLoseNoPair) {
  const Avatar pile = test::pile_of(300);
  const ActuatorMap map;
  const DetectorFrame frame = test::frame_through(pile, 100);
  for (const auto make : {make_geometry_detector, make_compute_detector}) {
    const auto detector = make(LimitedContext::make({{GL_MAX_TEXTURE_BUFFER_SIZE, 3 * 72}}), pile, map,
                               {.method = Method::kStatic, .skip = Skip::kOn, .culling = Culling::kCpu});
    ContactRow row;
    const DetectorWork work = detector->detect(frame, row);
    EXPECT_EQ(work.pairs_captured, 300U * 100U);
    EXPECT_EQ(work.pairs_meeting, 300U * 100U);
  }
}

/// Room for the corners of three meshlets, where shaders touch ten: they find that out.
TEST(SmallTextureBuffers, LeaveFramesThatTouchTooManyMeshletsToTheCpu) {
  const Avatar pile = test::pile_of(300);
  const ActuatorMap map;
  const auto compute =
      make_compute_detector(LimitedContext::make({{GL_MAX_TEXTURE_BUFFER_SIZE, 3 * 72}}), pile, map, kCulledByShaders);
  ContactRow row;
  const int before = LimitedContext::dispatches();
  EXPECT_EQ(compute->detect(test::frame_through(pile, 100), row).pairs_meeting, 300U * 100U);
  for (const Contact& contact : row) ASSERT_EQ(contact.triangle, 299U);
  EXPECT_EQ(LimitedContext::dispatches() - before, 2);
}

TEST(SmallStorageBlocks, LeaveAnAvatarThatTheyDoNotHoldToTheCpu) {
  const Avatar pile = test::pile_of(300);
  const ActuatorMap map;
  for (const GLint bytes : {3000, 1 << 20}) {
    const auto compute = make_compute_detector(LimitedContext::make({{GL_MAX_SHADER_STORAGE_BLOCK_SIZE, bytes}}), pile,
                                               map, kCulledByShaders);
    ContactRow row;
    const int before = LimitedContext::dispatches();
    EXPECT_EQ(compute->detect(test::frame_through(pile, 100), row).pairs_meeting, 300U * 100U);
    EXPECT_EQ(LimitedContext::dispatches() - before, bytes == 3000 ? 0 : 2);
  }
}

TEST(SmallStorageBlocks, ThatCannotHoldThePairsOfOneTriangleAreNamed) {
  const Avatar pile = test::pile_of(3);
  const ActuatorMap map;
  const auto geometry =
      make_geometry_detector(LimitedContext::make({{GL_MAX_SHADER_STORAGE_BLOCK_SIZE, kHeadBytes + kPairBytes * 100}}),
                             pile, map, {Surface::kAll, PlaneSet(), Method::kStatic, Skip::kOff});
  ContactRow row;
  EXPECT_EQ(geometry->detect(test::frame_through(pile, 100), row).pairs_meeting, 300U);
  EXPECT_THAT(test::message_of([&] { geometry->detect(test::frame_through(pile, 101), row); }),
              HasSubstr("101 pairs of segment and triangle do not fit"));
}

TEST(CapturedPairs, AreDrawnInRangesWhoseCountCannotWrap) {
  const auto context = test::make_context();
  CapturedPairs captured(current_gl(*context));
  std::vector<std::size_t> firsts;
  captured.capture(
      nullptr, 7, std::size_t{1} << 30,
      [&](std::size_t first, std::size_t count) {
        firsts.push_back(first);
        EXPECT_LT(count << 30, std::size_t{1} << 32);
      },
      [](const CapturedPair&) { FAIL() << "nothing was drawn"; });
  EXPECT_THAT(firsts, ::testing::ElementsAre(0, 3, 6));
}

TEST(SmallViewports, HaveRoomForEveryCollider) {
  const Avatar avatar = test::pile_of(1);
  const ActuatorMap map;
  const auto paper = make_paper_detector(LimitedContext::make({{GL_MAX_VIEWPORT_DIMS, 64}}), avatar, map, {});
  ContactRow row;
  paper->detect(test::frame_through(avatar, 1000), row);
  for (std::size_t i = 0; i < row.size(); ++i) ASSERT_TRUE(row[i].hit()) << i;
}

TEST(DriversThatLinkNoLargeShares, AreGivenSmallerOnesAndLoseNoContact) {
  const Avatar avatar = test::pile_of(1);
  const ActuatorMap map;
  ContactRow row;
  for (const bool as_on_gpu : {false, true}) {
    const auto paper = make_paper_detector(LimitedContext::make({}, 2), avatar, map, {.as_on_gpu = as_on_gpu});
    for (const std::uint32_t colliders : {100U, 3U, 200U}) {
      paper->detect(test::frame_through(avatar, colliders), row);
      for (std::size_t i = 0; i < row.size(); ++i) ASSERT_TRUE(row[i].hit()) << i;
    }
  }
  const auto refused = make_paper_detector(LimitedContext::make({}, 0), avatar, map, {});
  EXPECT_THAT(test::message_of([&] { refused->detect(test::frame_through(avatar, 100), row); }),
              HasSubstr("the driver does not accept a shader"));
}

TEST(ShaderArithmeticOfThisDriver, IsMeasuredInEveryStageAndBreaksNoProof) {
  // own context: OSMesa, beside the one of all tests
  for (const auto make_context : {test::make_context, make_osmesa_context}) {
    const auto context = make_context();
    const std::vector<StageArithmetic>& stages = context->info().arithmetic;
    ASSERT_EQ(stages.size(), 3U);
    EXPECT_EQ(stages[0].stage, "vertex");
    EXPECT_EQ(stages[1].stage, "geometry");
    EXPECT_EQ(stages[2].stage, "compute");
    for (const StageArithmetic& stage : stages) {
      EXPECT_EQ(stage.rounding, "nearest even") << stage.misrounded;
      EXPECT_LE(stage.division_error_ulp, 2.5);
    }
    require_proofs("compute", context->info());
  }
}

TEST(ShaderArithmeticThatBreaksAProof, RefusesGeometryByNameWithTheCauseAndTheRemedy) {
  const GlInfo gl = {.context = "egl-device-7",
                     .renderer = "Chopper",
                     .version = "4.5",
                     .vendor = "",
                     .arithmetic = {{.stage = "vertex", .rounding = "toward zero", .misrounded = "1 + 2 is 2, not 3"}}};
  EXPECT_THAT(test::message_of([&] { require_proofs("geometry", gl); }),
              ::testing::AllOf(HasSubstr("--detector geometry"), HasSubstr("Chopper"), HasSubstr("toward zero"),
                               HasSubstr("1 + 2 is 2, not 3"), HasSubstr("--detector cpu")));
}

TEST(ShaderArithmeticThatIsNotMeasured, RefusesGeometryByNameAndNoOtherDetector) {
  const Avatar avatar = test::pile_of(1);
  const ActuatorMap map;
  const auto refusing = [] { return LimitedContext::make({}, 1 << 30, test::Probe::kRefused); };
  for (const Skip skip : {Skip::kOff, Skip::kOn})
    EXPECT_THAT(
        test::message_of([&] {
          make_geometry_detector(refusing(), avatar, map, {Surface::kAll, PlaneSet(), Method::kStatic, skip});
        }),
        ::testing::AllOf(HasSubstr("--detector geometry"), HasSubstr("not measured"),
                         HasSubstr("0:7(2): error: this driver does not like it 0:8(1)"), HasSubstr("--detector cpu")));
  const auto paper = make_paper_detector(refusing(), avatar, map, {});
  EXPECT_TRUE(paper->gl_info().arithmetic.empty());
  EXPECT_THAT(paper->gl_info().probe_refusal, ::testing::EndsWith("..."));
  EXPECT_EQ(paper->gl_info().probe_refusal.size(), 300U);
  ContactRow row;
  paper->detect(test::frame_through(avatar, 1), row);
  EXPECT_TRUE(row[0].hit());
}

}  // namespace
}  // namespace vestige
