#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "detector/actuator_drive.hpp"
#include "detector/texture_hash.hpp"

namespace vestige {
namespace {

Contact contact_on(std::uint16_t actuator) {
  Contact contact;
  contact.triangle = 5;
  contact.t = 0.5F;
  contact.actuator = actuator;
  return contact;
}

TEST(BinaryLaw, SwitchesTheActuatorOfAContactOnAndHoldsIt) {
  ActuatorDrive law(make_law("binary", 2, {}));
  EXPECT_THAT(law.next(0, ContactRow{contact_on(2), Contact()}).duty, ::testing::ElementsAre(0, 255));
  EXPECT_THAT(law.next(0.059, {}).duty, ::testing::ElementsAre(0, 255));
  EXPECT_THAT(law.next(0.060, {}).duty, ::testing::ElementsAre(0, 0));
  EXPECT_THAT(law.next(0.070, ContactRow{contact_on(0)}).duty, ::testing::ElementsAre(0, 0));
}

TEST(BinaryLaw, WithoutHoldGivesTheRawFrames) {
  ActuatorDrive law(make_law("binary", 1, {.hold_s = 0}));
  EXPECT_THAT(law.next(0, ContactRow{contact_on(1)}).duty, ::testing::ElementsAre(255));
  EXPECT_THAT(law.next(0, {}).duty, ::testing::ElementsAre(0));
}

TEST(TextureHash, IsTheSha256OfTriangleTimeAndActuatorInLittleEndian) {
  TextureHash hash;
  hash.add({contact_on(3), Contact()});
  // printf '\x05\0\0\0\0\0\0\x3f\x03\0\xff\xff\xff\xff\0\0\x80\x7f\0\0' | sha256sum
  EXPECT_EQ(hash.hex(), "65694e4c5dcd3ed57221d90ed80462c729b834f23941c6ff68908b18176cffb0");
}

}  // namespace
}  // namespace vestige
