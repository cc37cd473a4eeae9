// Datagrams of Open Sound Control.

#include "traces/live/osc_packet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/osc.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige {
namespace {

using test::bone;
using test::bundle;
using test::bytes_of;
using test::collider;
using test::OscBuilder;
using ::testing::SizeIs;

TEST(OscPacket, HoldsMessagesOfBundlesWithinBundles) {
  const auto packet =
      bundle({collider(1, 0, 0, 0), bundle({collider(2, 0, 0, 0), bundle({})}), collider(3, 0.5F, 0, 0)});
  const auto messages = decode_osc_packet(packet);
  ASSERT_EQ(messages.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(messages[i].address, "/vestige/collider");
    EXPECT_EQ(std::get<std::int32_t>(messages[i].arguments[0]), static_cast<std::int32_t>(i + 1));
  }
  EXPECT_EQ(std::get<float>(messages[2].arguments[1]), 0.5F);
}

/// Arguments stand on multiples of 4, wherever liblo's union would want to be.
TEST(OscPacket, AStringMayFollowANumber) {
  for (std::size_t numbers = 0; numbers < 3; ++numbers) {
    const OscBuilder message(lo_message_new());
    for (std::size_t i = 0; i < numbers; ++i) lo_message_add_float(message.get(), 0.5F);
    lo_message_add_string(message.get(), "Hips");
    lo_message_add_double(message.get(), 2.5);
    const auto messages = decode_osc_packet(bytes_of("/VMC/Ext/Bone/Pos", message));
    ASSERT_THAT(messages, SizeIs(1));
    const std::vector<OscArgument>& arguments = messages[0].arguments;
    ASSERT_THAT(arguments, SizeIs(numbers + 2));
    EXPECT_EQ(std::get<std::string>(arguments[numbers]), "Hips");
    EXPECT_EQ(std::get<double>(arguments.back()), 2.5);
  }
}

TEST(OscPacket, CutAnywhereOrFlippedAnywhereIsRefusedOrRead) {
  const auto packet = bundle({bone("Hips", {1, 0, 0, 0}), bundle({collider(2, 1, 2, 3)})});
  for (std::size_t length = 0; length < packet.size(); ++length) {
    // A bundle may end after its time, or after any element.
    try {
      EXPECT_LT(decode_osc_packet(std::span(packet).first(length)).size(), 2U) << length;
    } catch (const mcap::Malformed&) {
      continue;
    }
  }
  for (std::size_t at = 0; at < packet.size(); ++at) {
    for (int flip = 1; flip < 256; flip += flip < 8 ? 1 : 31) {
      auto damaged = packet;
      damaged[at] ^= static_cast<std::byte>(flip);
      try {
        EXPECT_LE(decode_osc_packet(damaged).size(), 2U);
      } catch (const mcap::Malformed&) {
        continue;
      }
    }
  }
}

TEST(OscPacket, NestedWithoutEndIsRefused) {
  std::vector<std::byte> packet = bundle({});
  for (int i = 0; i < 100; ++i) packet = bundle({packet});
  EXPECT_THROW(decode_osc_packet(packet), mcap::Malformed);
}

}  // namespace
}  // namespace vestige
