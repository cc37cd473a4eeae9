// Sends frames to what stands in for bHaptics' Player. No real Player is known to have got any.

#include "transport/sinks/bhaptics_sink.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <functional>
#include <future>
#include <thread>

#include "tests/support/bhaptics/player.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/descriptor.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using test::BhapticsPlayer;
using test::message_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Names = std::vector<std::string>;

TEST(BhapticsUrl, NamesAHostAndPerhapsAPort) {
  EXPECT_EQ(parse_bhaptics_url("bhaptics://192.168.1.20").host, "192.168.1.20");
  EXPECT_EQ(parse_bhaptics_url("bhaptics://192.168.1.20").port, 15881);
  EXPECT_EQ(parse_bhaptics_url("bhaptics://localhost:9/").port, 9);
  EXPECT_EQ(parse_bhaptics_url("bhaptics://[::1]").host, "::1");
  for (const char* url : {"bhaptics://", "bhaptics://:1", "bhaptics://a:", "bhaptics://a:0", "bhaptics://a/b"})
    EXPECT_THAT(message_of([&] { parse_bhaptics_url(url); }),
                AllOf(HasSubstr("--port"), HasSubstr("bhaptics://127.0.0.1:15881")))
        << url;
}

TEST(BhapticsPlaces, FollowTheNamesOfActuators) {
  EXPECT_THAT(bhaptics_places({"front 1-1", "back 5-4", "front 2-1", "VestBack 0", "Head 5", "FootR 2"}, "a"),
              ElementsAre(BhapticsPlace{"VestFront", 0}, BhapticsPlace{"VestBack", 19}, BhapticsPlace{"VestFront", 4},
                          BhapticsPlace{"VestBack", 0}, BhapticsPlace{"Head", 5}, BhapticsPlace{"FootR", 2}));
  EXPECT_THAT(bhaptics_places({"1", "20", "21", "actuator 40"}, "a"),
              ElementsAre(BhapticsPlace{"VestFront", 0}, BhapticsPlace{"VestFront", 19}, BhapticsPlace{"VestBack", 0},
                          BhapticsPlace{"VestBack", 19}));
}

TEST(BhapticsPlaces, AreRefusedIfThereIsNoSuchVibrator) {
  for (const char* name : {"chest right", "front 6-1", "front 1-5", "front 0-1", "front 1", "VestFront 20",
                           "VestFront -1", "VestFront", "Head 6", "0", "41", "actuator 41", "", "Vest 1"})
    EXPECT_THAT(message_of([&] { bhaptics_places({name}, "bhaptics://a"); }),
                AllOf(HasSubstr("bhaptics://a"), HasSubstr(std::string("'") + name + "'"), HasSubstr("torso40")))
        << name;
  EXPECT_THAT(message_of([] { bhaptics_places({"front 1-2", "VestFront 1"}, "a"); }), HasSubstr("same vibrator"));
}

class BhapticsSinkTest : public ::testing::Test {
 protected:
  static BhapticsOptions at(std::uint16_t port) { return {.place = {.host = "127.0.0.1", .port = port}}; }

  static void send(BhapticsSink& sink, std::vector<std::uint8_t> level) {
    const ActuatorFrame frame = {0, std::move(level)};
    sink.send(frame, 1);
  }

  /// Does something again and again, for as long as a slow machine may need. Returns whether it came true.
  static bool comes_true(const std::function<bool()>& something) {
    for (int i = 0; i < 3000; ++i) {
      if (something()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  /// Returns why the link is lost, as soon as it is.
  static std::string loss(BhapticsSink& sink) {
    std::string why;
    comes_true([&] {
      try {
        sink.receive();
      } catch (const LinkLost& lost) {
        why = lost.what();
      }
      return !why.empty();
    });
    return why;
  }

  /// Sends until nothing more leaves: a burst alone keeps the network busy for a moment, too.
  static void fill(BhapticsSink& sink) {
    const auto is_stuck = [&] {
      for (int i = 0; i < 30; ++i) {
        if (sink.ready()) return false;
        std::this_thread::sleep_for(10ms);
      }
      return true;
    };
    for (int i = 0; i < 100'000 && !is_stuck(); ++i) send(sink, std::vector<std::uint8_t>(40, 255));
    EXPECT_FALSE(sink.ready());
  }

  static Names all_names() {
    Names names;
    for (int i = 1; i <= 40; ++i) names.push_back(std::to_string(i));
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(BhapticsSinkTest, ThePlayerPlaysWhatIsSentAndIsOffAtTheEnd) {
  BhapticsPlayer player(folder_.path());
  {
    BhapticsSink sink(at(player.port()), {"front 1-1", "back 5-4", "Head 5", "front 1-2"});
    EXPECT_TRUE(sink.ready());
    send(sink, {255, 128, 3, 0});
    send(sink, {0, 0, 0, 77});
    send(sink, {9});  // actuators beyond the levels are off, levels beyond the actuators are ignored
    send(sink, {0, 0, 0, 1, 255});
    sink.send_off(1);
    EXPECT_EQ(sink.texts_sent(), 5U);
    EXPECT_TRUE(sink.receive().empty());
  }
  const nlohmann::json report = player.report();
  EXPECT_THAT(report["faults"], IsEmpty()) << report;
  EXPECT_EQ(report["texts"], 5);
  EXPECT_EQ(report["frames"], 4);
  EXPECT_EQ(report["most"],
            nlohmann::json({{"VestFront 0", 100}, {"VestFront 1", 30}, {"VestBack 19", 50}, {"Head 5", 1}}));
  EXPECT_THAT(report["left_on"], IsEmpty());
}

TEST_F(BhapticsSinkTest, AZeroAloneSwitchesOffToo) {
  BhapticsPlayer player(folder_.path());
  {
    BhapticsSink sink(at(player.port()), {"1", "21"});
    send(sink, {255, 255});
    send(sink, {0, 0});
  }
  const nlohmann::json report = player.report();
  EXPECT_EQ(report["most"], nlohmann::json({{"VestFront 0", 100}, {"VestBack 0", 100}}));
  EXPECT_THAT(report["left_on"], IsEmpty());
}

TEST_F(BhapticsSinkTest, AFrameLastsAsLongAsItIsTold) {
  for (const auto& [most_ms, faults] : {std::pair("50", 0U), std::pair("49", 1U)}) {
    BhapticsPlayer player(folder_.path(), {"--most-ms", most_ms});
    BhapticsOptions options = at(player.port());
    options.duration = 50ms;
    {
      BhapticsSink sink(options, {"1"});
      send(sink, {255});
    }
    EXPECT_EQ(player.report()["faults"].size(), faults);
  }
}

TEST_F(BhapticsSinkTest, APlayerThatIsNotThereIsMissedUntilItComes) {
  const std::uint16_t port = BhapticsPlayer(folder_.path()).port();  // which is free again
  BhapticsSink sink(at(port), {"1"});
  EXPECT_FALSE(sink.ready());
  EXPECT_EQ(sink.readable_descriptor(), -1);
  EXPECT_THAT(loss(sink),
              AllOf(HasSubstr("there is no connection to bHaptics' Player"), HasSubstr("start the Player")));
  EXPECT_THROW(send(sink, {1}), LinkLost);
  EXPECT_THROW(sink.send_off(1), LinkLost);
  EXPECT_FALSE(sink.reconnect());
  BhapticsPlayer player(folder_.path(), {"--port", std::to_string(port)});
  ASSERT_EQ(player.port(), port);
  ASSERT_TRUE(comes_true([&] { return sink.reconnect(); }));
  send(sink, {255});
  EXPECT_TRUE(player.wait_for("on"));
}

TEST_F(BhapticsSinkTest, APlayerThatClosesIsMissedAndFoundAgain) {
  BhapticsPlayer player(folder_.path(), {"--texts", "2", "--connections", "2"});
  BhapticsSink sink(at(player.port()), all_names());
  for (int connection = 0; connection < 2; ++connection) {
    send(sink, {255});
    send(sink, {255});
    EXPECT_THAT(loss(sink), HasSubstr("the connection was closed"));
    EXPECT_EQ(player.report()["texts"], 2);
    if (connection == 0) {
      ASSERT_TRUE(comes_true([&] { return sink.reconnect(); }));
    }
  }
}

TEST_F(BhapticsSinkTest, APlayerThatReadsNothingHoldsNothingUp) {
  BhapticsPlayer player(folder_.path(), {"--deaf", "--connections", "2"});
  BhapticsSink sink(at(player.port()), all_names());
  fill(sink);
  EXPECT_NE(loss(sink), "");  // it is given up
  ASSERT_TRUE(comes_true([&] { return sink.reconnect(); }));
  fill(sink);
  const std::string why = message_of([&] {
    for (int i = 0; i < 1'000'000; ++i) sink.send_off(1);
  });
  EXPECT_THAT(why, HasSubstr("it takes no more data"));
  EXPECT_FALSE(sink.ready());
}

TEST_F(BhapticsSinkTest, NonsenseFromThePlayerDoesNoHarm) {
  BhapticsPlayer player(folder_.path(), {"--garbage"});
  {
    BhapticsSink sink(at(player.port()), all_names());
    for (int i = 0; i < 50; ++i) {
      ASSERT_TRUE(comes_true([&] {
        sink.receive();
        return sink.ready();
      }));
      send(sink, {255});
    }
    sink.send_off(1);
    std::future<bool> is_off = std::async(std::launch::async, [&] { return player.wait_for("off"); });
    ASSERT_TRUE(comes_true([&] {  // it takes texts only while its nonsense is read
      sink.receive();
      return is_off.wait_for(0s) == std::future_status::ready;
    }));
    EXPECT_TRUE(is_off.get());
  }
  const nlohmann::json report = player.report();
  EXPECT_EQ(report["texts"], 51) << report;
  EXPECT_THAT(report["left_on"], IsEmpty());
}

TEST_F(BhapticsSinkTest, WhatIsNoPlayerIsALostLink) {
  BhapticsPlayer breaks(folder_.path(), {"--breaks"});
  BhapticsSink broken(at(breaks.port()), {"1"});
  EXPECT_NE(loss(broken), "");
  BhapticsPlayer refuses(folder_.path(), {"--refuse"});
  BhapticsSink refused(at(refuses.port()), {"1"});
  EXPECT_NE(loss(refused), "");
}

TEST_F(BhapticsSinkTest, AServerThatNeverAnswersIsNotWaitedFor) {
  const Descriptor server(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in place = {};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t bytes = sizeof(place);
  auto* const address = reinterpret_cast<sockaddr*>(&place);
  ASSERT_EQ(::bind(server.value(), address, bytes), 0);
  ASSERT_EQ(::listen(server.value(), 8), 0);
  ASSERT_EQ(::getsockname(server.value(), address, &bytes), 0);
  BhapticsSink sink(at(ntohs(place.sin_port)), {"1"});
  EXPECT_THAT(loss(sink), HasSubstr("does not answer"));
  EXPECT_FALSE(sink.reconnect());
  EXPECT_THROW(sink.send_off(1), LinkLost);
}

TEST_F(BhapticsSinkTest, AnUnknownHostIsAnError) {
  EXPECT_THAT(message_of([] {
                BhapticsSink({.place = {"no.such.host.invalid", 1}}, {"1"});
              }),
              HasSubstr("'no.such.host.invalid' is not known"));
}

}  // namespace
}  // namespace vestige
