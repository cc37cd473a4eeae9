// What the shaders of the candidates say, and how a driver that leaves their work undone is noticed.
#include "detector/proofs/candidate_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "tests/support/message_of.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Words = std::array<std::uint32_t, kSlotLanes>;

/// The words of lanes that tested so many segments and found nothing.
Words complete(std::uint32_t segments) {
  Words words;
  words.fill((8 + segments) << 28U);
  return words;
}

std::array<std::uint32_t, kSlotSegments> unpacked(const Words& words, std::size_t segments) {
  std::array<std::uint32_t, kSlotSegments> bits;
  bits.fill(77);
  unpack_words(words, segments, bits.data());
  return bits;
}

TEST(WordsOfASlot, SayWhichTrianglesEachSegmentMayMeet) {
  EXPECT_THAT(unpacked(complete(3), 3), ElementsAre(0, 0, 0, 77, 77, 77, 77));
  Words words = complete(7);
  words[0] |= 1;               // the first segment and the first triangle
  words[1] |= 0b1010U << 4U;   // the second, and two triangles of the second lane
  words[7] |= 0b1000U << 24U;  // the last of both
  EXPECT_THAT(unpacked(words, 7), ElementsAre(1, 0b1010U << 4U, 0, 0, 0, 0, 1U << 31U));
}

TEST(WordsOfASlot, AreRefusedIfALaneDidNotTestAllSegments) {
  for (const std::uint32_t tested : {1U, 2U, 4U}) {
    Words words = complete(3);
    words[5] = (8 + tested) << 28U;
    EXPECT_THAT(test::message_of([&] { unpacked(words, 3); }), HasSubstr("ended a shader before its work was done"));
  }
  Words unwritten = complete(3);
  unwritten[0] = 0;
  EXPECT_THAT(test::message_of([&] { unpacked(unwritten, 3); }), HasSubstr("--detector cpu"));
}

}  // namespace
}  // namespace vestige
