#include "transport/wire/xbee_api.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "traces/base/error.hpp"
#include "transport/wire/vest_frame.hpp"

namespace vestige {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Bytes text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

// The frames of the first tests are the examples printed in Digi's user guides.

TEST(Xbee, WrapsATx16FrameAsItsManualDoes) {
  EXPECT_THAT(
      xbee_wrap({.request = XbeeRequest::kTx16, .escaping = XbeeEscaping::kNone, .address = 0x5001}, 1, text("Hello")),
      ElementsAre(0x7E, 0x00, 0x0A, 0x01, 0x01, 0x50, 0x01, 0x00, 'H', 'e', 'l', 'l', 'o', 0xB8));
}

TEST(Xbee, WrapsATransmitRequestAsItsManualDoes) {
  const XbeeOptions plain{XbeeRequest::kTransmit, XbeeEscaping::kNone, 0x0013A200400A0127};
  EXPECT_THAT(xbee_wrap(plain, 1, text("TxData0A")),
              ElementsAre(0x7E, 0x00, 0x16, 0x10, 0x01, 0x00, 0x13, 0xA2, 0x00, 0x40, 0x0A, 0x01, 0x27, 0xFF, 0xFE,
                          0x00, 0x00, 0x54, 0x78, 0x44, 0x61, 0x74, 0x61, 0x30, 0x41, 0x13));
  const XbeeOptions escaped{XbeeRequest::kTransmit, XbeeEscaping::kEscaped, 0x0013A200400A0127};
  EXPECT_THAT(xbee_wrap(escaped, 1, text("TxData0A")),
              ElementsAre(0x7E, 0x00, 0x16, 0x10, 0x01, 0x00, 0x7D, 0x33, 0xA2, 0x00, 0x40, 0x0A, 0x01, 0x27, 0xFF,
                          0xFE, 0x00, 0x00, 0x54, 0x78, 0x44, 0x61, 0x74, 0x61, 0x30, 0x41, 0x7D, 0x33));
}

TEST(Xbee, AddsAsManyBytesAsThePlanForTheLineSays) {
  const Bytes frame(14, 1);
  EXPECT_EQ(xbee_wrap({.request = XbeeRequest::kTransmit}, 1, frame).size(), 14U + 18U);
  EXPECT_EQ(xbee_wrap({.request = XbeeRequest::kTx16}, 1, frame).size(), 14U + 9U);
}

TEST(Xbee, UnwrapsWhatAnotherRadioSent) {
  // "RxData" from 0013A200 40522BAA
  const Bytes frame{0x7E, 0x00, 0x12, 0x90, 0x00, 0x13, 0xA2, 0x00, 0x40, 0x52, 0x2B,
                    0xAA, 0x7D, 0x84, 0x01, 'R',  'x',  'D',  'a',  't',  'a',  0x0D};
  XbeeUnwrapper unwrapper(XbeeEscaping::kNone);
  EXPECT_EQ(unwrapper.push(frame), text("RxData"));
  EXPECT_EQ(unwrapper.damaged(), 0U);
}

Bytes from_module(XbeeEscaping escaping, const Bytes& data) {
  // Worked out anew, not with the product's own wrapping.
  unsigned sum = 0;
  for (const std::uint8_t byte : data) sum += byte;
  Bytes plain{static_cast<std::uint8_t>(data.size() >> 8U), static_cast<std::uint8_t>(data.size() & 0xFFU)};
  plain.insert(plain.end(), data.begin(), data.end());
  plain.push_back(static_cast<std::uint8_t>(0xFF - (sum & 0xFFU)));
  Bytes frame{0x7E};
  for (const std::uint8_t byte : plain) {
    const bool special = byte == 0x7E || byte == 0x7D || byte == 0x11 || byte == 0x13;
    if (escaping == XbeeEscaping::kEscaped && special)
      frame.insert(frame.end(), {0x7D, static_cast<std::uint8_t>(byte ^ 0x20U)});
    else
      frame.push_back(byte);
  }
  return frame;
}

/// A received packet from a 16-bit address.
Bytes packet(XbeeEscaping escaping, const Bytes& payload) {
  Bytes data{0x81, 0x50, 0x01, 0x28, 0x00};
  data.insert(data.end(), payload.begin(), payload.end());
  return from_module(escaping, data);
}

TEST(Xbee, UnwrapsTheReceivedPacketsOfEveryKindOfModule) {
  XbeeUnwrapper unwrapper(XbeeEscaping::kNone);
  EXPECT_EQ(unwrapper.push(packet(XbeeEscaping::kNone, {1, 2, 3})), Bytes({1, 2, 3}));
  const Bytes rx64{0x80, 0, 0x13, 0xA2, 0, 0x40, 0x52, 0x2B, 0xAA, 0x28, 0, 4, 5};
  EXPECT_EQ(unwrapper.push(from_module(XbeeEscaping::kNone, rx64)), Bytes({4, 5}));
}

TEST(Xbee, CountsWhatArrivedAndWhatDidNot) {
  XbeeUnwrapper unwrapper(XbeeEscaping::kNone);
  // Frame 1 to 7D84: delivered
  EXPECT_TRUE(unwrapper.push(Bytes{0x7E, 0x00, 0x07, 0x8B, 0x01, 0x7D, 0x84, 0x00, 0x00, 0x01, 0x71}).empty());
  EXPECT_TRUE(unwrapper.push(from_module(XbeeEscaping::kNone, {0x89, 2, 0})).empty());
  EXPECT_EQ(unwrapper.delivered(), 2U);
  EXPECT_EQ(unwrapper.undelivered(), 0U);
  unwrapper.push(from_module(XbeeEscaping::kNone, {0x8B, 3, 0xFF, 0xFE, 3, 0x24, 2}));
  EXPECT_EQ(unwrapper.last_failure(), 0x24);
  unwrapper.push(from_module(XbeeEscaping::kNone, {0x89, 4, 1}));
  EXPECT_EQ(unwrapper.last_failure(), 1);
  EXPECT_EQ(unwrapper.delivered(), 2U);
  EXPECT_EQ(unwrapper.undelivered(), 2U);
  EXPECT_THAT(std::string(xbee_failure(unwrapper.last_failure())), HasSubstr("did not acknowledge"));
}

TEST(Xbee, TakesNothingFromFramesInWhichTheModuleSpeaksOfItself) {
  XbeeUnwrapper unwrapper(XbeeEscaping::kNone);
  EXPECT_TRUE(unwrapper.push(from_module(XbeeEscaping::kNone, {0x8A, 6})).empty());
  EXPECT_TRUE(unwrapper.push(from_module(XbeeEscaping::kNone, {0x81, 1})).empty()) << "shorter than its own header";
  EXPECT_TRUE(unwrapper.push(from_module(XbeeEscaping::kNone, {0x89})).empty());
  EXPECT_EQ(unwrapper.damaged() + unwrapper.delivered() + unwrapper.undelivered(), 0U);
}

TEST(Xbee, RefusesEveryFlippedBitAndEveryCutAndHearsTheNextFrame) {
  for (const XbeeEscaping escaping : {XbeeEscaping::kNone, XbeeEscaping::kEscaped}) {
    const Bytes payload{0x7E, 0x7D, 0x11, 0x13, 0x00, 0x5E};
    const Bytes whole = packet(escaping, payload);
    // Enough frames to end whatever length a flip may have announced.
    Bytes more;
    for (int i = 0; i < 40; ++i) more.insert(more.end(), whole.begin(), whole.end());
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      Bytes flipped = whole;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1U << bit % 8);
      XbeeUnwrapper unwrapper(escaping);
      Bytes received = unwrapper.push(flipped);
      EXPECT_TRUE(received.empty()) << "bit " << bit;
      received = unwrapper.push(more);
      EXPECT_EQ(received.size() % payload.size(), 0U) << "bit " << bit;
      // In AP = 1 a length that was flipped to a longer one swallows nothing either: its checksum fails, and what it
      // spans is looked through again.
      EXPECT_EQ(received.size(), 40 * payload.size()) << "bit " << bit;
    }
    for (std::size_t length = 0; length < whole.size(); ++length) {
      XbeeUnwrapper unwrapper(escaping);
      EXPECT_TRUE(unwrapper.push(std::span(whole).first(length)).empty());
      EXPECT_EQ(unwrapper.push(more).size(), 40 * payload.size()) << "length " << length;
    }
  }
}

TEST(Xbee, RefusesWhatDoesNotFitAndNamesTheWayOut) {
  try {
    xbee_wrap({}, 1, Bytes(101, 0));
    FAIL() << "wrapped";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("101 bytes"));
    EXPECT_THAT(error.what(), HasSubstr("AP = 0"));
  }
  try {
    xbee_wrap({.request = XbeeRequest::kTx16, .escaping = XbeeEscaping::kNone, .address = 0x10000}, 1, Bytes{1});
    FAIL() << "the address was cut";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("10000"));
    EXPECT_THAT(error.what(), HasSubstr("MY"));
  }
}

TEST(Xbee, HearsTheFrameAfterACutOneAtOnceWhereStartsAreUnmistakable) {
  const Bytes whole = packet(XbeeEscaping::kEscaped, {1, 2, 3});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    XbeeUnwrapper unwrapper(XbeeEscaping::kEscaped);
    unwrapper.push(std::span(whole).first(length));
    EXPECT_EQ(unwrapper.push(whole), Bytes({1, 2, 3})) << "length " << length;
  }
}

RC_GTEST_PROP(Xbee, GivesBackWhatWasWrappedFromWhateverPieces, ()) {
  const auto escaping = *rc::gen::element(XbeeEscaping::kNone, XbeeEscaping::kEscaped);
  const auto payloads = *rc::gen::container<std::vector<Bytes>>(rc::gen::container<Bytes>(
      rc::gen::oneOf(rc::gen::arbitrary<std::uint8_t>(), rc::gen::element<std::uint8_t>(0x7E, 0x7D, 0x11, 0x13))));
  Bytes line;
  Bytes sent;
  for (const Bytes& payload : payloads) {
    const Bytes frame = packet(escaping, payload);
    line.insert(line.end(), frame.begin(), frame.end());
    sent.insert(sent.end(), payload.begin(), payload.end());
  }
  XbeeUnwrapper unwrapper(escaping);
  Bytes received;
  for (std::span<const std::uint8_t> rest(line); !rest.empty();) {
    const auto length = *rc::gen::inRange<std::size_t>(1, rest.size() + 1);
    const Bytes piece = unwrapper.push(rest.first(length));
    received.insert(received.end(), piece.begin(), piece.end());
    rest = rest.subspan(length);
  }
  RC_ASSERT(received == sent);
  RC_ASSERT(unwrapper.damaged() == 0U);
}

RC_GTEST_PROP(Xbee, SendsNoSpecialByteUnescaped, (const std::vector<std::uint8_t>& payload)) {
  RC_PRE(payload.size() <= kXbeePayload_bytes);
  const XbeeOptions options{XbeeRequest::kTransmit, XbeeEscaping::kEscaped, 0x7E7D1113};
  const Bytes frame = xbee_wrap(options, 0x11, payload);
  RC_ASSERT(std::count(frame.begin(), frame.end(), 0x7E) == 1);
  RC_ASSERT(std::count(frame.begin(), frame.end(), 0x11) + std::count(frame.begin(), frame.end(), 0x13) == 0);
}

TEST(Xbee, CarriesAFrameOfSixtyFourActuatorsInOnePacket) {
  const Bytes frame = encode_state(Quantity::kDuty, Bytes(64, 200), 1, 20);
  EXPECT_EQ(xbee_wrap(XbeeOptions(), 1, frame).size(), 72U + 18U);
}

}  // namespace
}  // namespace vestige
