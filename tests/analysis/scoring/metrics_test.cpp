// Each metric by itself, against numbers found by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/scoring/balance.hpp"
#include "analysis/scoring/information.hpp"
#include "analysis/scoring/link_load.hpp"
#include "analysis/scoring/localisation.hpp"
#include "analysis/scoring/slide_score.hpp"
#include "analysis/scoring/timing_score.hpp"
#include "tests/support/flat_body.hpp"

namespace vestige {
namespace {

TEST(TransmittedBits, AreLog2OfTheRegionsForAPerfectMapping) {
  for (const std::size_t n : {1U, 2U, 6U, 8U, 40U}) {
    std::vector<double> counts(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) counts[i * n + i] = 25;
    EXPECT_NEAR(transmitted_bits(counts, n), std::log2(n), 1e-13) << n;
  }
}

TEST(TransmittedBits, AreNoneForAnswersThatDoNotDependOnTheRegion) {
  EXPECT_NEAR(transmitted_bits(std::vector<double>{3, 6, 1, 2}, 2), 0, 1e-15);
  EXPECT_EQ(transmitted_bits(std::vector<double>{0, 0, 0, 0}, 2), 0);
}

TEST(TransmittedBits, AreANumberHoweverSeldomAnAnswerIs) {
  // Half of all is 0 or 1, told apart; the third answer is as good as never given.
  EXPECT_NEAR(transmitted_bits(std::vector<double>{1, 0, 1e-310, 0, 1, 0}, 3), 1, 1e-13);
  EXPECT_GE(transmitted_bits(std::vector<double>{0.1, 0.3, 0.7, 0.1 / 3, 0.1, 0.7 / 3}, 3), 0);
}

TEST(TransmittedBits, OfAChannelThatErrsOneTimeInFour) {
  // 1 - H(1/4) = 0.188722 bits.
  EXPECT_NEAR(transmitted_bits(std::vector<double>{3, 1, 1, 3}, 2), 0.1887218755408671, 1e-14);
}

TEST(RegionObserver, LearnsEverythingFromActuatorsFarApartAndLittleFromOnesAcrossItsAcuity) {
  const auto bits_of = [](double apart_m) {
    const ActuatorLayout layout(test::flat_body(32),
                                test::nearest_map({{0.5 - apart_m / 2, 0.5}, {0.5 + apart_m / 2, 0.5}}, 64));
    RegionObserver observer(2);
    for (int i = 0; i < 10; ++i) {
      observer.add_single(0, 0);
      observer.add_single(1, 1);
    }
    return observer.bits(layout);
  };
  EXPECT_NEAR(bits_of(0.4), 1, 1e-12);
  // Confused with the other by e / (1 + e), e = exp(-(25 mm / 12.5 mm)² / 2): 1 - H(0.1192).
  EXPECT_NEAR(bits_of(0.025), 0.4729, 2e-3);
  EXPECT_LT(bits_of(0.005), 0.03);
}

TEST(RegionObserver, CannotTellRegionsWhoseContactsFireNothing) {
  const ActuatorLayout layout(test::flat_body(8), test::nearest_map({{0.2, 0.5}, {0.8, 0.5}}, 64));
  RegionObserver observer(2);
  observer.add_unfelt(0);
  observer.add_unfelt(1);
  EXPECT_EQ(observer.bits(layout), 0);
  EXPECT_TRUE(std::isnan(RegionObserver(2).bits(layout)));
}

TEST(RegionObserver, FeelsWhatSeveralActuatorsFireInTheirMiddle) {
  const ActuatorLayout layout(test::flat_body(32), test::nearest_map({{0.45, 0.5}, {0.55, 0.5}}, 64));
  LocatedContact contact;
  const auto bits_of = [&](double felt_right_m) {
    RegionObserver observer(2);
    for (int i = 0; i < 10; ++i) {
      layout.locate(test::contact_at(0.47, 0.5, 32), contact);
      observer.add(0, layout, contact, {0, 0});  // where it is: nearer to the first
      layout.locate(test::contact_at(0.53, 0.5, 32), contact);
      observer.add(1, layout, contact, layout.towards_m(contact, 1) * (felt_right_m / 0.02));
    }
    return observer.bits(layout);
  };
  // Named rightly with 1 / (1 + e), e = exp(-(80² - 20²) / (2 * 12.5²) mm²) = 4.6e-9.
  EXPECT_NEAR(bits_of(0), 1, 1e-6);
  // Felt at the midpoint, the second is named half of the time: H(1/4) - 1/2.
  EXPECT_NEAR(bits_of(-0.03), 0.3113, 1e-3);
}

TEST(UseEvenness, IsOneForEvenUseAndNoneForOneActuator) {
  EXPECT_DOUBLE_EQ(use_evenness(std::vector<double>{2, 2, 2, 2}), 1);
  EXPECT_DOUBLE_EQ(use_evenness(std::vector<double>{0, 5, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(use_evenness(std::vector<double>{1, 1, 0, 0}), 0.5);
  EXPECT_NEAR(use_evenness(std::vector<double>{3, 1}), 0.8112781244591328, 1e-14);
  EXPECT_TRUE(std::isnan(use_evenness(std::vector<double>{0, 0})));
  EXPECT_TRUE(std::isnan(use_evenness(std::vector<double>{1})));
}

TEST(LinkLoad, KnowsWhatAStateWeighsOnTheLine) {
  EXPECT_EQ(state_bytes(6), 14U);  // as measured from the vest's own frames
  EXPECT_EQ(state_bytes(40), 48U);
}

TEST(LinkLoad, LetsTheLatestOfThoseThatWaitLeave) {
  // 100 bytes at 10 kB/s: 10 ms each.
  LinkLoad link(100, 10000);
  link.post(0.000);  // leaves at once
  link.post(0.002);  // waits for 0.010 …
  link.post(0.004);  // … and is overtaken
  link.post(0.012);  // 0.004's left at 0.010; this one waits for 0.020
  link.post(0.050);  // by then it is gone
  EXPECT_EQ(link.changes(), 5U);
  EXPECT_EQ(link.superseded(), 1U);
  link.finish(0.050);
  // 0, 10, 20, again at 40 since nothing is new, and the last waits for 50: five frames.
  EXPECT_EQ(link.bytes_sent(), 500);
}

TEST(LinkLoad, RefreshesAnUnchangedStateAndKeepsTheFloor) {
  LinkLoad quiet(14, 5760);
  quiet.post(0);
  quiet.finish(1.001);
  EXPECT_EQ(quiet.bytes_sent(), 51 * 14);
  LinkLoad busy(1, 1e6);  // a fast line still leaves 5 ms between frames
  for (int i = 0; i < 1000; ++i) busy.post(i * 0.001);
  EXPECT_NEAR(busy.bytes_sent(), 200, 1);
  EXPECT_NEAR(static_cast<double>(busy.superseded()), 800, 2);
}

TEST(TimingScore, IsPerfectWhereActuatorsVibrateWhenAsked) {
  TimingScore timing(2);
  timing.ask(1, 4, 0.397);
  timing.begins(1, 0.400);
  timing.vibrates(1, 4);
  timing.ends(1, 0.410);
  EXPECT_EQ(timing.f1(), 1);
  EXPECT_NEAR(timing.mean_onset_s(), 0.003, 1e-12);
  EXPECT_NEAR(timing.mean_offset_s(), 0.013, 1e-12);
  EXPECT_EQ(timing.late_share(0), 0);
}

TEST(TimingScore, CountsWhatIsMissedAndWhatIsUnasked) {
  TimingScore timing(2);
  timing.ask(0, 0, 0.001);
  timing.ask(0, 0, 0.002);  // two contacts of a frame ask once
  timing.begins(0, 0.048);
  timing.vibrates(0, 0);
  timing.vibrates(0, 1);
  timing.vibrates(0, 2);
  timing.ask_nothing();
  // 1 right, 2 unasked, 1 missed: 2 / (2 + 2 + 1).
  EXPECT_DOUBLE_EQ(timing.f1(), 0.4);
  EXPECT_NEAR(timing.mean_onset_s(), 0.047, 1e-12);
  EXPECT_EQ(timing.late_share(0), 1);
  EXPECT_EQ(timing.late_share(1), 1);
  EXPECT_EQ(timing.late_share(2), 0);
  EXPECT_TRUE(std::isnan(timing.mean_offset_s()));
  EXPECT_TRUE(std::isnan(TimingScore(1).f1()));
}

TEST(SlideFinder, TakesContactsThatFollowEachOtherAlongTheSkin) {
  SlideFinder slides;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(slides.breaks(0, 0.02 * i, {0.012 * i, 0, 0}), false);
    slides.add(0, 0.02 * i, {0.012 * i, 0, 0});
  }
  EXPECT_TRUE(slides.is_slide(0));
  EXPECT_NEAR(slides.way_m(0), 0.060, 1e-12);
  EXPECT_TRUE(slides.breaks(0, 0.11, {0.2, 0, 0})) << "a leap";
  EXPECT_TRUE(slides.breaks(0, 0.3, {0.06, 0, 0})) << "a pause";
  slides.add(0, 0.3, {0.06, 0, 0});
  EXPECT_FALSE(slides.is_slide(0)) << "one contact is none";
  // To and fro on one spot is none either.
  for (int i = 0; i < 50; ++i) slides.add(3, 0.01 * i, {0.01 * (i % 2), 0, 0});
  EXPECT_FALSE(slides.is_slide(3));
}

TEST(SlideSmoothness, TakesNoRoundingForAReversal) {
  SlideSmoothness slide;
  const glm::dvec3 there(0.1, 0, 0);
  const glm::dvec3 behind(0.1 - 1e-16, 0, 0);
  slide.add(1, &there, glm::dvec3(0.01, 0, 0));
  slide.add(0.5, &behind, glm::dvec3(0.01, 0, 0));
  EXPECT_EQ(slide.reversals(), 0U);
}

TEST(SlideSmoothness, SeesRippleJumpsAndReversals) {
  SlideSmoothness slide;
  const glm::dvec3 step(0.01, 0, 0);
  const glm::dvec3 places[] = {{0, 0, 0}, {0.02, 0, 0}, {0.01, 0, 0}, {0.05, 0, 0}};
  const double energies[] = {1, 0.5, 1, 1.5};
  for (int i = 0; i < 4; ++i) slide.add(energies[i], &places[i], step);
  EXPECT_DOUBLE_EQ(slide.ripple(), 1);
  EXPECT_DOUBLE_EQ(slide.largest_jump_m(), 0.04);
  EXPECT_EQ(slide.reversals(), 1U);
  SlideScore score;
  EXPECT_TRUE(std::isnan(score.ripple()));
  score.add(slide, 0.5);
  EXPECT_DOUBLE_EQ(score.reversals_per_m(), 2);
  SlideSmoothness unfelt;
  unfelt.add(0, nullptr, step);
  EXPECT_TRUE(std::isnan(unfelt.ripple()));
  // It makes nothing look smoother.
  score.add(unfelt, 10);
  EXPECT_DOUBLE_EQ(score.ripple(), 1);
  EXPECT_DOUBLE_EQ(score.largest_jump_m(), 0.04);
  EXPECT_DOUBLE_EQ(score.reversals_per_m(), 2);
  EXPECT_EQ(score.slides(), 2U);
}

TEST(Acuity, IsFinerAtTheMidline) {
  EXPECT_EQ(acuity_m({0.02, 1.3, 0.1}, 0), 0.010);
  EXPECT_EQ(acuity_m({-0.10, 1.3, 0.1}, 0), 0.025);
}

}  // namespace
}  // namespace vestige
