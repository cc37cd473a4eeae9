#include "detector/actuators/intensity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "detector/actuators/actuator_drive.hpp"
#include "detector/output/texture_hash.hpp"
#include "tests/support/flat_body.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kCells = 16;

Contact contact_on(std::uint16_t actuator) {
  Contact contact;
  contact.triangle = 5;
  contact.t = 0.5F;
  contact.actuator = actuator;
  return contact;
}

/// Two actuators half a metre apart, and three.
std::shared_ptr<const ActuatorLayout> layout_of(const std::vector<glm::dvec2>& places) {
  return std::make_shared<ActuatorLayout>(test::flat_body(kCells), test::nearest_map(places, 128));
}
const std::vector<glm::dvec2> kTwo = {{0.25, 0.5}, {0.75, 0.5}};
const std::vector<glm::dvec2> kThree = {{0.25, 0.25}, {0.75, 0.25}, {0.5, 0.75}};

ActuatorMap map_of(std::size_t actuators) {
  ActuatorMap map;
  map.actuator_count = actuators;
  for (std::size_t i = 1; i <= actuators; ++i) map.names.push_back("actuator " + std::to_string(i));
  return map;
}

Contact contact_on(const std::shared_ptr<const ActuatorLayout>& layout, double x, double y) {
  Contact contact = test::contact_at(x, y, kCells);
  contact.actuator = layout->map().at(contact.texture_coordinate);
  return contact;
}

std::vector<double> amplitudes(std::string_view law, const std::vector<glm::dvec2>& places, double x, double y,
                               const LawOptions& options = {}) {
  const auto layout = layout_of(places);
  return make_law(law, layout, options)->next(0, ContactRow{contact_on(layout, x, y)});
}

ActuatorMap map_that_fires(const char* fires, std::size_t actuators = 3) {
  ActuatorMap map = map_of(actuators);
  map.firing = Firing(nlohmann::json::parse(fires), map.names, "map");
  return map;
}

TEST(Firing, LetsARegionFireOthersThanItsOwn) {
  const ActuatorMap map = map_that_fires(R"({"actuator 1": {"actuator 2": 1, "3": 0.5}, "2": {}})");
  const auto law = make_law("binary", map, {.hold_s = 0});
  EXPECT_THAT(law->next(0, ContactRow{contact_on(1)}), ElementsAre(0, 1, 0.5));
  EXPECT_THAT(law->next(1, ContactRow{contact_on(2)}), ElementsAre(0, 0, 0));
  EXPECT_THAT(law->next(2, ContactRow{contact_on(3)}), ElementsAre(0, 0, 1));
  EXPECT_THAT(law->next(3, ContactRow{contact_on(1), contact_on(3)}), ElementsAre(0, 1, 1));  // the strongest
  EXPECT_EQ(describe(map.firing.of(0), map.names), "actuator 2, actuator 3 (0.5)");
  EXPECT_EQ(describe(map.firing.of(1), map.names), "nothing");
}

TEST(Firing, FollowsAnotherMap) {
  const auto law = make_law("binary", map_of(3), {.hold_s = 0});
  EXPECT_THAT(law->next(0, ContactRow{contact_on(1)}), ElementsAre(1, 0, 0));
  law->change_map(map_that_fires(R"({"1": {"3": 1}})").firing, nullptr);
  EXPECT_THAT(law->next(1, ContactRow{contact_on(1)}), ElementsAre(0, 0, 1));
}

TEST(Firing, RefusesWhatIsNotThere) {
  const auto message = [](const char* fires) -> std::string {
    try {
      map_that_fires(fires);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(R"([])"), HasSubstr("'fires' is not an object"));
  EXPECT_THAT(message(R"({"back": {"1": 1}})"), HasSubstr("there is no actuator 'back'"));
  EXPECT_THAT(message(R"({"1": {"4": 1}})"), HasSubstr("there is no actuator '4'"));
  EXPECT_THAT(message(R"({"1": {"2": 0}})"), HasSubstr("the gain of '2' is 0"));
  EXPECT_THAT(message(R"({"1": {"2": 1.5}})"), HasSubstr("the gain of '2' is 1.5"));
  EXPECT_THAT(message(R"({"1": {"2": "much"}})"), HasSubstr("the gain of '2'"));
  EXPECT_THAT(message(R"({"1": ["2"]})"), HasSubstr("is not an object of actuators and gains"));
  EXPECT_THAT(message(R"({"1": {}, "actuator 1": {}})"), HasSubstr("is listed twice"));
  EXPECT_THAT(message(R"({"1": {"2": 1, "actuator 2": 1}})"), HasSubstr("actuator 2 is listed twice"));
}

TEST(BinaryLaw, SwitchesTheActuatorOfAContactOnAndHoldsIt) {
  ActuatorDrive law(make_law("binary", map_of(2), {}));
  EXPECT_THAT(law.next(0, ContactRow{contact_on(2), Contact()}).duty, ElementsAre(0, 255));
  EXPECT_THAT(law.next(0.059, {}).duty, ElementsAre(0, 255));
  EXPECT_THAT(law.next(0.060, {}).duty, ElementsAre(0, 0));
  EXPECT_THAT(law.next(0.070, ContactRow{contact_on(0)}).duty, ElementsAre(0, 0));
}

TEST(BinaryLaw, WithoutHoldGivesTheRawFrames) {
  ActuatorDrive law(make_law("binary", map_of(1), {.hold_s = 0}));
  EXPECT_THAT(law.next(0, ContactRow{contact_on(1)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0, {}).duty, ElementsAre(0));
}

TEST(SpeedLaw, IsAsStrongAsTheImpactIsFastAndHoldsTheStrongest) {
  const auto law = make_law("speed", map_of(1), {.full_speed_m_per_s = 2});
  const auto at = [&](double time_s, double speed_m_per_s) {
    Contact contact = contact_on(1);
    contact.speed_m_per_s = speed_m_per_s;
    return law->next(time_s, ContactRow{contact}).front();
  };
  EXPECT_EQ(at(0, 0.5), 0.25);
  EXPECT_EQ(at(0.02, 5), 1);
  EXPECT_EQ(at(0.05, 1), 1);
  EXPECT_EQ(law->next(0.085, {}).front(), 0.5);  // the weaker one lasts until 0.11
  EXPECT_EQ(law->next(0.11, {}).front(), 0);
  EXPECT_EQ(at(1, 0), 0);
  EXPECT_EQ(at(2, std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(PhantomLaw, SharesAContactBetweenTwoActuatorsByTheRootOfTheWay) {
  for (const double share : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0}) {
    const double x = 0.25 + 0.5 * share;
    EXPECT_THAT(amplitudes("phantom", kTwo, x, 0.5),
                ElementsAre(DoubleNear(std::sqrt(1 - share), 2e-3), DoubleNear(std::sqrt(share), 2e-3)));
    EXPECT_THAT(amplitudes("linear", kTwo, x, 0.5), ElementsAre(DoubleNear(1 - share, 1e-5), DoubleNear(share, 1e-5)));
  }
  // Beside the line, by the nearest place on it; beyond its ends, by the end.
  EXPECT_THAT(amplitudes("linear", kTwo, 0.35, 0.7), ElementsAre(DoubleNear(0.8, 1e-5), DoubleNear(0.2, 1e-5)));
  EXPECT_THAT(amplitudes("phantom", kTwo, 0.1, 0.4), ElementsAre(1, 0));
}

TEST(PhantomLaw, SharesAContactAmongThreeActuatorsSoThatTheirMiddleIsWhereItIs) {
  const auto weights = amplitudes("linear", kThree, 0.5, 0.5);
  EXPECT_THAT(weights, ElementsAre(DoubleNear(0.25, 1e-5), DoubleNear(0.25, 1e-5), DoubleNear(0.5, 1e-5)));
  const auto amplitude = amplitudes("phantom", kThree, 0.6, 0.4);
  double energy = 0;
  glm::dvec2 middle(0);
  for (std::size_t i = 0; i < 3; ++i) {
    energy += amplitude[i] * amplitude[i];
    middle += amplitude[i] * amplitude[i] * kThree[i];
  }
  EXPECT_NEAR(energy, 1, 1e-12);
  EXPECT_NEAR(middle.x, 0.6, 1e-5);
  EXPECT_NEAR(middle.y, 0.4, 1e-5);
}

TEST(PhantomLaw, OfOneActuatorIsBinary) {
  EXPECT_THAT(amplitudes("phantom", {{0.5, 0.5}}, 0.9, 0.2), ElementsAre(1));
  EXPECT_THAT(amplitudes("gaussian", {{0.5, 0.5}}, 0.9, 0.2), ElementsAre(1));
}

TEST(PhantomLaw, LetsAColliderThatMovesOnLeaveNothingBehind) {
  const auto layout = layout_of(kTwo);
  const auto law = make_law("phantom", layout, {});
  const auto other = [&](double x) { return contact_on(layout, x, 0.5); };
  law->next(0, ContactRow{other(0.25)});
  EXPECT_THAT(law->next(0.01, ContactRow{other(0.75)}), ElementsAre(DoubleNear(0, 2e-3), DoubleNear(1, 1e-6)));
  // Of another collider it is another contact; and without one, it is held.
  EXPECT_THAT(law->next(0.02, ContactRow{Contact(), other(0.25)}),
              ElementsAre(DoubleNear(1, 1e-6), DoubleNear(1, 1e-6)));
  EXPECT_THAT(law->next(0.0699, {}), ElementsAre(DoubleNear(1, 1e-6), DoubleNear(1, 1e-6)));
  EXPECT_THAT(law->next(0.0700, {}), ElementsAre(DoubleNear(1, 1e-6), DoubleNear(0, 2e-3)));
  EXPECT_THAT(law->next(0.08, {}), ElementsAre(0, 0));
}

TEST(GaussianLaw, FallsOffWithTheDistanceAlongTheSkin) {
  EXPECT_THAT(amplitudes("gaussian", kTwo, 0.35, 0.5, {.sigma_m = 0.2}),
              ElementsAre(DoubleNear(std::exp(-0.125), 1e-5), DoubleNear(std::exp(-2), 1e-5)));
  // Half the spacing, where nobody says.
  EXPECT_THAT(amplitudes("gaussian", kTwo, 0.5, 0.5),
              ElementsAre(DoubleNear(std::exp(-0.5), 1e-5), DoubleNear(std::exp(-0.5), 1e-5)));
  // What would round to nothing is nothing.
  EXPECT_THAT(amplitudes("gaussian", kTwo, 0.25, 0.5, {.sigma_m = 0.05}), ElementsAre(DoubleNear(1, 1e-5), 0));
}

TEST(GaussianLaw, LeavesActuatorsAloneThatAreNowhere) {
  ActuatorMap map = test::nearest_map({{0.5, 0.5}}, 128);
  map.actuator_count = 3;
  map.names = {"here", "nowhere", "nowhere either"};
  map.position_m.resize(3);
  const auto layout = std::make_shared<ActuatorLayout>(test::flat_body(kCells), map);
  EXPECT_THAT(make_law("gaussian", layout, {})->next(0, ContactRow{contact_on(layout, 0.4, 0.5)}),
              ElementsAre(1, 0, 0));
}

/// A sphere that touches the flat body at (x, y) and ends so far above it, in a frame.
struct Pressed {
  DetectorFrame frame;
  ContactRow row;

  Pressed(const std::shared_ptr<const ActuatorLayout>& layout, double x, double y, float above_m, float radius_m)
      : frame(test::frame_of(test::flat_body(kCells), {})), row{contact_on(layout, x, y)} {
    const glm::vec3 centre(x, y, above_m);
    frame.segments = {{0, centre, centre, radius_m}};
    frame.columns = 1;
  }
};

TEST(PatchLaw, FiresEveryActuatorThatTheSphereCovers) {
  const auto layout = layout_of(kThree);
  const auto law = make_law("patch", layout, {.hold_s = 0.05, .full_depth_m = 0.125});
  const Pressed wide(layout, 0.5, 0.25, 0, 0.3125F);
  EXPECT_THAT(law->next(0, wide.row, &wide.frame), ElementsAre(0.5, 0.5, 0)) << "(5/16 - 1/4) m of 1/8 m";
  const Pressed above(layout, 0.25, 0.25, 0.1875F, 0.25F);
  EXPECT_THAT(law->next(0.01, above.row, &above.frame), ElementsAre(0.5, 0, 0)) << "it replaces what was before";
  const Pressed deep(layout, 0.25, 0.25, -0.0625F, 0.25F);
  EXPECT_THAT(law->next(0.02, deep.row, &deep.frame), ElementsAre(1, 0, 0)) << "no more than fully";
  EXPECT_THAT(law->next(0.06, ContactRow{Contact()}, &deep.frame), ElementsAre(1, 0, 0)) << "held";
  EXPECT_THAT(law->next(0.08, ContactRow{Contact()}, nullptr), ElementsAre(0, 0, 0));
}

TEST(PatchLaw, FiresActuatorsFromSkinThatNoneCovers) {
  const auto layout =
      std::make_shared<ActuatorLayout>(test::flat_body(kCells), test::nearest_map({{0.25, 0.25}}, 128, 0.0625));
  const auto law = make_law("patch", layout, {.full_depth_m = 0.125});
  const Pressed beside(layout, 0.5, 0.25, 0, 0.375F);
  EXPECT_EQ(beside.row[0].actuator, 0);
  EXPECT_THAT(law->next(0, beside.row, &beside.frame), ElementsAre(1));
}

TEST(PatchLaw, FollowsTheSkinAsItIsPosed) {
  const auto layout = layout_of(kTwo);
  const auto law = make_law("patch", layout, {.full_depth_m = 0.125});
  Pressed moved(layout, 0.25, 0.5, 0, 0.125F);
  moved.frame.palette[0].column[3].x = -0.5F;  // the body moves half a metre to the left
  EXPECT_THAT(law->next(0, moved.row, &moved.frame), ElementsAre(0, 1));
}

TEST(DepthLaw, OfASphereDrivesTheContactsActuator) {
  const auto law = make_law("depth", map_of(2), {.hold_s = 0.05, .full_depth_m = 0.01});
  ContactRow row = {contact_on(2)};
  EXPECT_THAT(law->next(0, row), ElementsAre(0, 0)) << "a point is never deep";
  row[0].depth_m = 0.0025;
  EXPECT_THAT(law->next(0.001, row), ElementsAre(0, 0.25));
  row[0].depth_m = 0.02;
  EXPECT_THAT(law->next(0.002, row), ElementsAre(0, 1));
  row[0].depth_m = 0.005;
  EXPECT_THAT(law->next(0.003, row), ElementsAre(0, 0.5)) << "what is felt follows the depth";
  EXPECT_THAT(law->next(0.05, ContactRow{Contact()}), ElementsAre(0, 0.5)) << "held from the last frame of the touch";
  EXPECT_THAT(law->next(0.06, ContactRow{Contact()}), ElementsAre(0, 0));
}

TEST(IntensityLaws, LetSkinThatNoActuatorCoversFireNothing) {
  const auto layout = std::make_shared<ActuatorLayout>(test::flat_body(kCells), test::nearest_map(kTwo, 128, 0.1));
  for (const LawInfo& law : laws()) {
    Contact contact = test::contact_at(0.5, 0.5, kCells);
    contact.speed_m_per_s = 1;
    EXPECT_THAT(make_law(law.name, layout, {})->next(0, ContactRow{contact}), ElementsAre(0, 0)) << law.name;
    EXPECT_EQ(make_law(law.name, layout, {})->name(), law.name);
  }
}

TEST(IntensityLaws, TakeTheStrongestOfSeveralContacts) {
  const auto layout = layout_of(kTwo);
  const ContactRow row = {contact_on(layout, 0.25, 0.5), contact_on(layout, 0.45, 0.5), contact_on(layout, 0.5, 0.5)};
  EXPECT_THAT(make_law("linear", layout, {})->next(0, row), ElementsAre(DoubleNear(1, 1e-6), DoubleNear(0.5, 1e-5)));
}

TEST(IntensityLaws, AreRefusedByOtherNamesNamingTheRealOnes) {
  try {
    make_law("sine", map_of(1), {});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("phantom"));
  }
}

TEST(TextureHash, IsTheSha256OfTriangleTimeAndActuatorInLittleEndian) {
  TextureHash hash;
  hash.add({contact_on(3), Contact()});
  // printf '\x05\0\0\0\0\0\0\x3f\x03\0\xff\xff\xff\xff\0\0\x80\x7f\0\0' | sha256sum
  EXPECT_EQ(hash.hex(), "65694e4c5dcd3ed57221d90ed80462c729b834f23941c6ff68908b18176cffb0");
}

}  // namespace
}  // namespace vestige
