#include "transport/wire/cobs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "transport/wire/crc16.hpp"

namespace vestige {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;

TEST(Crc16, GivesTheCheckValueOfItsKind) {
  const Bytes digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc16(digits), 0x29B1);
  EXPECT_EQ(crc16({}), 0xFFFF);
}

// Worked out by hand.
TEST(Cobs, WritesZerosAsDistances) {
  EXPECT_THAT(cobs_encode({}), ElementsAre(1));
  EXPECT_THAT(cobs_encode(Bytes{0}), ElementsAre(1, 1));
  EXPECT_THAT(cobs_encode(Bytes{0, 0x11, 0}), ElementsAre(1, 2, 0x11, 1));
  EXPECT_THAT(cobs_encode(Bytes{0x11, 0x22, 0, 0x33}), ElementsAre(3, 0x11, 0x22, 2, 0x33));
}

/// `first`, first + 1, …
Bytes count_up(std::uint8_t first, std::size_t length) {
  Bytes bytes(length);
  std::iota(bytes.begin(), bytes.end(), first);
  return bytes;
}

TEST(Cobs, OpensASecondBlockOnlyWhenMoreThan254BytesStandWithoutAZero) {
  Bytes full = count_up(1, 254);
  Bytes expected = full;
  expected.insert(expected.begin(), 0xFF);
  EXPECT_EQ(cobs_encode(full), expected);
  EXPECT_EQ(cobs_decode(expected), full);

  full.push_back(0xFF);
  expected.insert(expected.end(), {2, 0xFF});
  EXPECT_EQ(cobs_encode(full), expected);
  EXPECT_EQ(cobs_decode(expected), full);

  full.back() = 0;
  expected = count_up(1, 254);
  expected.insert(expected.begin(), 0xFF);
  expected.insert(expected.end(), {1, 1});
  EXPECT_EQ(cobs_encode(full), expected);
  EXPECT_EQ(cobs_decode(expected), full);
}

TEST(Cobs, RefusesWhatNoPayloadGives) {
  EXPECT_FALSE(cobs_decode({}).has_value());
  EXPECT_FALSE(cobs_decode(Bytes{2}).has_value()) << "a block that is cut off";
  EXPECT_FALSE(cobs_decode(Bytes{3, 0x11}).has_value()) << "a block that is cut off";
  EXPECT_FALSE(cobs_decode(Bytes{2, 0}).has_value()) << "a zero within";
  EXPECT_FALSE(cobs_decode(Bytes{0}).has_value());
}

RC_GTEST_PROP(Cobs, GivesBackEveryPayloadAndHoldsNoZero, ()) {
  // Zeros are rare or frequent, and blocks as long as they can be.
  const auto most = *rc::gen::element<std::uint8_t>(1, 2, 40, 255);
  const auto length = *rc::gen::inRange<std::size_t>(0, 800);
  const auto payload = *rc::gen::container<Bytes>(length, rc::gen::inRange<std::uint8_t>(0, most));
  Bytes shifted = payload;
  if (*rc::gen::arbitrary<bool>())
    for (std::uint8_t& byte : shifted) byte = static_cast<std::uint8_t>(byte + 1);
  const Bytes frame = cobs_encode(shifted);
  RC_ASSERT(std::find(frame.begin(), frame.end(), 0) == frame.end());
  RC_ASSERT(frame.size() <= shifted.size() + shifted.size() / 254 + 1);
  RC_ASSERT(cobs_decode(frame) == shifted);
}

}  // namespace
}  // namespace vestige
