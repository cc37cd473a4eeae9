#include "transport/wire/vest_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/transport/wire/wire_answers.hpp"
#include "transport/wire/cobs.hpp"

namespace vestige {
namespace {

using test::Bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// CRCs below: from a bitwise loop in another language, over the payload that the comment shows.

TEST(VestFrame, SaysHello) {
  // 48 00, crc 996A
  EXPECT_THAT(encode_hello(0), ElementsAre(0x02, 0x48, 0x03, 0x6A, 0x99, 0x00));
}

TEST(VestFrame, CarriesSixDuties) {
  // 53 01 14 06 00 33 66 99 CC FF, crc F9B3; 14 bytes on the line, as vests with six motors are planned for
  EXPECT_THAT(encode_state(Quantity::kDuty, Bytes{0, 51, 102, 153, 204, 255}, 1, 20),
              ElementsAre(0x05, 0x53, 0x01, 0x14, 0x06, 0x08, 0x33, 0x66, 0x99, 0xCC, 0xFF, 0xB3, 0xF9, 0x00));
  // 53 00 14 06 00 00 00 00 00 00, crc 2586
  EXPECT_THAT(encode_state(Quantity::kDuty, Bytes(6, 0), 0, 20),
              ElementsAre(0x02, 0x53, 0x03, 0x14, 0x06, 0x01, 0x01, 0x01, 0x01, 0x01, 0x03, 0x86, 0x25, 0x00));
}

TEST(VestFrame, CarriesPressures) {
  // 50 01 14 02 0A C8, crc DC6C
  EXPECT_THAT(encode_state(Quantity::kPressure, Bytes{10, 200}, 1, 20),
              ElementsAre(0x09, 0x50, 0x01, 0x14, 0x02, 0x0A, 0xC8, 0x6C, 0xDC, 0x00));
}

TEST(VestFrame, SwitchesAllOff) {
  // 58 07 00 00, crc F1A8
  EXPECT_THAT(encode_off(7), ElementsAre(0x03, 0x58, 0x07, 0x01, 0x03, 0xA8, 0xF1, 0x00));
}

TEST(VestFrame, HoldsAsManyActuatorsAsItsCountCanSayAndNoMore) {
  const Bytes level(255, 1);
  const Bytes frame = encode_state(Quantity::kDuty, level, 9, 20);
  EXPECT_EQ(frame.size(), 4U + 255U + 2U + 2U + 1U);  // COBS needs two blocks
  EXPECT_EQ(std::count(frame.begin(), frame.end(), 0), 1);
  try {
    encode_state(Quantity::kDuty, Bytes(256, 1), 9, 20);
    FAIL() << "the count has wrapped round";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("255 actuators, and there are 256"));
  }
}

TEST(VestFrame, OfSixtyFourActuatorsIsSeventyTwoBytes) {
  EXPECT_EQ(encode_state(Quantity::kDuty, Bytes(64, 200), 9, 20).size(), 72U);
}

TEST(VestFrame, TakesABoardTwoMillisecondsForEachOfItsChips) {
  EXPECT_EQ(chips_of(6), 1U);
  EXPECT_EQ(chips_of(16), 1U);
  EXPECT_EQ(chips_of(17), 2U);
  EXPECT_EQ(chips_of(64), 4U);
  EXPECT_EQ(board_time(16), std::chrono::milliseconds(2));
  EXPECT_EQ(board_time(64), std::chrono::milliseconds(8));
}

TEST(VestAnswer, SaysThatTheOutputsHaveFailed) {
  VestAnswerDecoder decoder;
  Bytes line = test::acknowledgement(1, 5, 0);
  for (const Bytes& more : {test::acknowledgement(2, 1, 0), test::greeting(3, 1, 64, 5), test::greeting(4, 1, 64, 3)})
    line.insert(line.end(), more.begin(), more.end());
  const std::vector<VestAnswer> answers = decoder.push(line);
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_TRUE(std::get<Acknowledgement>(answers[0]).outputs_failed);
  EXPECT_FALSE(std::get<Acknowledgement>(answers[1]).outputs_failed);
  EXPECT_TRUE(std::get<Greeting>(answers[2]).outputs_failed);
  EXPECT_FALSE(std::get<Greeting>(answers[3]).outputs_failed);
}

TEST(VestAnswer, IsAnAcknowledgement) {
  VestAnswerDecoder decoder;
  // 41 01 03 05, crc AE2E
  const std::vector<VestAnswer> answers = decoder.push(Bytes{0x07, 0x41, 0x01, 0x03, 0x05, 0x2E, 0xAE, 0x00});
  ASSERT_EQ(answers.size(), 1U);
  const auto& acknowledgement = std::get<Acknowledgement>(answers[0]);
  EXPECT_EQ(acknowledgement.sequence, 1);
  EXPECT_TRUE(acknowledgement.was_in_fail_safe);
  EXPECT_TRUE(acknowledgement.overrun);
  EXPECT_EQ(acknowledgement.receive_errors, 5);
  EXPECT_EQ(decoder.damaged(), 0U);
}

TEST(VestAnswer, IsAGreeting) {
  VestAnswerDecoder decoder;
  // 48 00 01 06 01, crc 8FFE
  const std::vector<VestAnswer> answers = decoder.push(Bytes{0x02, 0x48, 0x06, 0x01, 0x06, 0x01, 0xFE, 0x8F, 0x00});
  ASSERT_EQ(answers.size(), 1U);
  const auto& greeting = std::get<Greeting>(answers[0]);
  EXPECT_EQ(greeting.sequence, 0);
  EXPECT_EQ(greeting.version, 1);
  EXPECT_EQ(greeting.actuator_count, 6);
  EXPECT_TRUE(greeting.was_in_fail_safe);
  EXPECT_FALSE(greeting.overrun);
}

TEST(VestAnswer, IsRefusedWithAnyOneBitFlipped) {
  for (const Bytes& frame : {test::acknowledgement(1, 3, 5), test::greeting(7, 1, 6, 1)}) {
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
      Bytes flipped = frame;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      VestAnswerDecoder decoder;
      EXPECT_TRUE(decoder.push(flipped).empty()) << "bit " << bit;
      // What comes after it is heard, once a zero has ended what the flip left open.
      EXPECT_TRUE(decoder.push(Bytes{0}).empty()) << "bit " << bit;
      EXPECT_GE(decoder.damaged(), 1U) << "bit " << bit;
      EXPECT_EQ(decoder.push(frame).size(), 1U) << "bit " << bit;
    }
  }
}

TEST(VestAnswer, IsRefusedWhenCutAnywhere) {
  for (const Bytes& frame : {test::acknowledgement(1, 3, 5), test::greeting(7, 1, 6, 1)}) {
    for (std::size_t length = 1; length + 1 < frame.size(); ++length) {
      Bytes begun(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(length));
      begun.push_back(0);
      Bytes ended(frame.begin() + static_cast<std::ptrdiff_t>(length), frame.end());
      for (const Bytes& part : {begun, ended}) {
        VestAnswerDecoder decoder;
        EXPECT_TRUE(decoder.push(part).empty()) << "length " << length;
        EXPECT_EQ(decoder.damaged(), 1U) << "length " << length;
      }
    }
  }
}

TEST(VestAnswer, IsRefusedWhenItsKindIsUnknownOrItsLengthWrong) {
  for (const Bytes& payload : {Bytes{}, Bytes{'A'}, Bytes{'A', 1, 0}, Bytes{'A', 1, 0, 0, 0}, Bytes{'H', 1, 1, 6},
                               Bytes{'H', 1}, Bytes{'S', 1, 20, 0}, Bytes{'a', 1, 0, 0}, Bytes{'H', 1, 1, 6, 0, 0}}) {
    VestAnswerDecoder decoder;
    EXPECT_TRUE(decoder.push(test::sealed(payload)).empty());
    EXPECT_EQ(decoder.damaged(), 1U);
  }
}

TEST(VestAnswer, IsFoundBehindNoiseWithoutEnd) {
  VestAnswerDecoder decoder;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(decoder.push(Bytes(1000, 0x55)).empty());
  EXPECT_TRUE(decoder.push(test::acknowledgement(1, 0, 0)).empty()) << "it is the end of the noise";
  EXPECT_EQ(decoder.damaged(), 1U);
  EXPECT_EQ(decoder.push(test::acknowledgement(1, 0, 0)).size(), 1U);
}

TEST(VestAnswer, CountsNoEmptyFramesAsDamaged) {
  VestAnswerDecoder decoder;
  EXPECT_TRUE(decoder.push(Bytes(50, 0)).empty());
  EXPECT_EQ(decoder.damaged(), 0U);
}

RC_GTEST_PROP(VestAnswer, ComesWholeFromWhateverPieces, (const std::vector<std::uint8_t>& sequences)) {
  Bytes line;
  for (const std::uint8_t sequence : sequences) {
    const Bytes frame = test::acknowledgement(sequence, 0, 0);
    line.insert(line.end(), frame.begin(), frame.end());
  }
  VestAnswerDecoder decoder;
  std::vector<std::uint8_t> heard;
  for (std::span<const std::uint8_t> rest(line); !rest.empty();) {
    const auto length = *rc::gen::inRange<std::size_t>(1, rest.size() + 1);
    for (const VestAnswer& answer : decoder.push(rest.first(length)))
      heard.push_back(std::get<Acknowledgement>(answer).sequence);
    rest = rest.subspan(length);
  }
  RC_ASSERT(heard == sequences);
  RC_ASSERT(decoder.damaged() == 0U);
}

}  // namespace
}  // namespace vestige
