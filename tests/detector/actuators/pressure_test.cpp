#include "detector/actuators/pressure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace vestige {
namespace {

using ::testing::ElementsAre;

Contact contact_on(std::uint16_t actuator, double speed_m_per_s) {
  Contact contact;
  contact.triangle = 5;
  contact.actuator = actuator;
  contact.speed_m_per_s = speed_m_per_s;
  return contact;
}

TEST(Pressure, IsTheShareOfAMetrePerSecondAlongTheNormal) {
  EXPECT_EQ(pressure_of(contact_on(1, 0)), 0);
  EXPECT_EQ(pressure_of(contact_on(1, 0.25)), 0.25);
  EXPECT_EQ(pressure_of(contact_on(1, 1)), 1);
  EXPECT_EQ(pressure_of(contact_on(1, 400)), 1);
  EXPECT_EQ(pressure_of(contact_on(1, std::numeric_limits<double>::infinity())), 1);
  EXPECT_EQ(pressure_of(contact_on(1, std::numeric_limits<double>::quiet_NaN())), 0);
}

TEST(PressureLaw, GivesTheLargestPressureOfAnActuatorsContacts) {
  PressureLaw law(3, 0);
  // 255 * 0.1 = 25.5, 255 * 0.5 = 127.5 and 255 * 0.25 = 63.75.
  const ContactRow row = {contact_on(1, 0.1), contact_on(2, 0.5), contact_on(2, 0.3),
                          contact_on(0, 1),   Contact(),          contact_on(3, 0.25)};
  EXPECT_THAT(law.next(0, row).duty, ElementsAre(26, 128, 64));
  EXPECT_THAT(law.next(0.01, {}).duty, ElementsAre(0, 0, 0));
}

TEST(PressureLaw, HoldsAPressureAndThenThatOfALaterWeakerContact) {
  PressureLaw law(1, 0.060);
  EXPECT_THAT(law.next(0.00, {contact_on(1, 0.2)}).duty, ElementsAre(51));
  EXPECT_THAT(law.next(0.01, {contact_on(1, 1)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.02, {contact_on(1, 0.6)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.03, {contact_on(1, 0.4)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.069, {}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.075, {}).duty, ElementsAre(153));  // 0.6, until 0.08
  EXPECT_THAT(law.next(0.085, {}).duty, ElementsAre(102));  // 0.4, until 0.09
  EXPECT_THAT(law.next(0.091, {}).duty, ElementsAre(0));
}

TEST(PressureLaw, StartsAnewWithEachContactOfTheSameStrength) {
  PressureLaw law(1, 0.060);
  EXPECT_THAT(law.next(0.00, {contact_on(1, 1)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.05, {contact_on(1, 1)}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.10, {}).duty, ElementsAre(255));
  EXPECT_THAT(law.next(0.12, {}).duty, ElementsAre(0));
}

}  // namespace
}  // namespace vestige
