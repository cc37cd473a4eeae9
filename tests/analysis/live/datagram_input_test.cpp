// Live input by datagrams, over loopback.

#include "analysis/live/datagram_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <thread>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/osc.hpp"
#include "tests/support/udp.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using test::bundle;
using test::collider;
using test::placement;
using test::with_id;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Bytes = std::vector<std::byte>;

/// A frame that ends, with its root at x. VMC's x is mirrored.
Bytes pose_at(double x) {
  return bundle({placement("/VMC/Ext/Root/Pos", "root", {-x, 0, 0}, {1, 0, 0, 0}), with_id("/VMC/Ext/OK", 1)});
}

class ByDatagrams : public ::testing::Test {
 protected:
  ByDatagrams() { open(PoseShown::kInterpolate); }

  void open(PoseShown poses) {
    input_.reset();
    const std::vector<LivePort> ports = {{"vmc://port", {"127.0.0.1", port_}, avatar_}};
    input_ = std::make_unique<DatagramInput>(ports, poses, 100ms);
  }

  /// Sends datagrams, and lets the input take all of them at once.
  void take(const std::vector<Bytes>& datagrams) {
    for (const Bytes& datagram : datagrams) sender_.send(datagram);
    std::this_thread::sleep_for(5ms);
    input_->receive();
  }

  /// Where the root is that is shown at a time.
  double x_at(LiveInput::Clock::time_point time) {
    input_->show(time, live_);
    const Pose rest = rest_pose(avatar_);
    for (std::size_t i = 0; i < rest.nodes.size(); ++i)
      if (const float moved = live_.frame.poses[0].nodes[i].translation.x - rest.nodes[i].translation.x; moved != 0)
        return double{moved};
    return 0;
  }
  double x_now() { return x_at(input_->arrived()); }

  const Avatar avatar_ = test::builtin_avatar();
  const std::uint16_t port_ = test::free_udp_port();
  const test::UdpSender sender_{port_};
  std::unique_ptr<DatagramInput> input_;
  LiveFrame live_;
};

TEST_F(ByDatagrams, TheNewestOfAllThatHasArrivedIsShownAndTheRestIsCounted) {
  EXPECT_FALSE(input_->has_begun());
  take({pose_at(0.1), pose_at(0.2), pose_at(0.3)});
  EXPECT_TRUE(input_->has_begun());
  EXPECT_NEAR(x_now(), 0.3, 1e-6);
  EXPECT_EQ(input_->superseded(), 2U);
  EXPECT_EQ(input_->frames(), 3U);
  EXPECT_TRUE(live_.begins);
  EXPECT_GE(live_.decoded, live_.arrived);
}

TEST_F(ByDatagrams, AFrameHasArrivedWhenItCameAndNotWhenItWasRead) {
  // The system begins to stamp a little after the first socket has asked for it.
  for (int i = 0; i < 400; ++i) {
    const auto before = LiveInput::Clock::now();
    take({pose_at(0.1)});
    const auto after = LiveInput::Clock::now();
    ASSERT_GE(input_->arrived(), before - 1ms);
    ASSERT_LE(input_->arrived(), after);
    if (input_->arrived() <= after - 4ms) return;
  }
  FAIL() << "no frame had arrived before it was read";
}

TEST_F(ByDatagrams, APoseBetweenWhichCollidersCameIsLedToWithoutAJump) {
  take({pose_at(0.1)});
  x_now();
  take({collider(1, 5, 5, 5)});
  EXPECT_NEAR(x_now(), 0.1, 1e-6);
  take({pose_at(0.2)});
  EXPECT_NEAR(x_now(), 0.1, 1e-6) << "one pose late";
  EXPECT_GT(live_.pose_delay_s, 0.005);
  EXPECT_LT(live_.pose_delay_s, 0.2);
  const auto way =
      std::chrono::duration_cast<LiveInput::Clock::duration>(std::chrono::duration<double>(live_.pose_delay_s));
  EXPECT_NEAR(x_at(input_->arrived() + way / 2), 0.15, 1e-3);
  EXPECT_NEAR(x_at(input_->arrived() + 2 * way), 0.2, 1e-6);
  EXPECT_EQ(live_.pose_delay_s, 0);
  EXPECT_FALSE(live_.begins);
  take({pose_at(0.3)});
  EXPECT_LT(x_now(), 0.25);
  take({pose_at(0.4)});
  EXPECT_LT(x_now(), 0.35) << "no collider came in between now, but one may come again";
  EXPECT_GT(live_.pose_delay_s, 0);
}

TEST_F(ByDatagrams, AFrameAtATimeOfItsOwnSeesNoJumpEither) {
  take({pose_at(0.1)});
  x_now();
  x_at(input_->arrived() + 5ms);  // with a rate, or for another person
  take({pose_at(0.2)});
  EXPECT_NEAR(x_now(), 0.1, 1e-6);
}

TEST_F(ByDatagrams, OfTwoPeopleOneMayFallSilent) {
  const std::uint16_t other_port = test::free_udp_port();
  const std::vector<LivePort> ports = {{"vmc://one", {"127.0.0.1", other_port}, avatar_},
                                       {"vmc://two", {"127.0.0.1", port_}, avatar_}};
  input_.reset();  // which has the port
  input_ = std::make_unique<DatagramInput>(ports, PoseShown::kLatest, 500ms);
  const test::UdpSender other(other_port);
  other.send(bundle({pose_at(0.1), collider(1, 0, 0, 0)}));
  take({collider(2, 0, 0, 0)});
  x_now();
  EXPECT_EQ(live_.is_silent, std::vector<bool>({false, false}));
  EXPECT_EQ(live_.frame.colliders.size(), 2U);
  std::this_thread::sleep_for(600ms);
  take({collider(2, 0, 0, 1)});
  x_now();
  EXPECT_EQ(live_.is_silent, std::vector<bool>({true, false}));
  ASSERT_EQ(live_.frame.colliders.size(), 1U) << "what the silent one sent is gone";
  EXPECT_EQ(live_.frame.colliders[0].id, 2U);
  EXPECT_THAT(input_->take_problems(), ::testing::ElementsAre(HasSubstr("vmc://one: no whole frame came for 500 ms")));
  other.send(pose_at(0.1));
  take({});
  x_now();
  EXPECT_EQ(live_.is_silent, std::vector<bool>({false, false}));
}

TEST_F(ByDatagrams, WhoIsWaitedForIsSaidOnce) {
  const std::vector<LivePort> ports = {{"vmc://one", {"127.0.0.1", test::free_udp_port()}, avatar_},
                                       {"vmc://two", {"127.0.0.1", port_}, avatar_}};
  input_.reset();  // which has the port
  input_ = std::make_unique<DatagramInput>(ports, PoseShown::kLatest, 500ms);
  take({});
  std::this_thread::sleep_for(1100ms);
  take({pose_at(0.1)});
  EXPECT_THAT(input_->take_problems(), IsEmpty()) << "only the first has come, just now";
  std::this_thread::sleep_for(1100ms);
  take({pose_at(0.2)});
  EXPECT_THAT(input_->take_problems(),
              ::testing::ElementsAre(HasSubstr("vmc://one: no whole frame has come to this port yet")));
  take({pose_at(0.3)});
  EXPECT_THAT(input_->take_problems(), IsEmpty());
}

TEST_F(ByDatagrams, APoseAfterAPoseAndTheLatestOnDemandAreShownAtOnce) {
  take({pose_at(0.1)});
  x_now();
  take({pose_at(0.2)});
  EXPECT_NEAR(x_now(), 0.2, 1e-6) << "poses are no slower than the rest";
  EXPECT_FALSE(live_.begins);
  open(PoseShown::kLatest);
  take({pose_at(0.1)});
  x_now();
  take({collider(1, 5, 5, 5)});
  take({pose_at(0.2)});
  EXPECT_NEAR(x_now(), 0.2, 1e-6);
  EXPECT_EQ(live_.pose_delay_s, 0);
}

TEST_F(ByDatagrams, AJumpIsNoMotion) {
  take({pose_at(0.1)});
  x_now();
  take({collider(1, 5, 5, 5), pose_at(1.2)});
  EXPECT_NEAR(x_now(), 1.2, 1e-6) << "shown at once";
  EXPECT_TRUE(live_.begins);
  take({pose_at(1.3)});
  x_now();
  EXPECT_FALSE(live_.begins);
  std::this_thread::sleep_for(210ms);
  take({pose_at(1.4)});
  x_now();
  EXPECT_TRUE(live_.begins) << "nobody knows what was between";
}

TEST_F(ByDatagrams, FaultsAreToldOnceAndCounted) {
  take({pose_at(0.1)});
  const test::UdpSender other(port_);
  other.send(pose_at(0.9));
  take({pose_at(std::numeric_limits<double>::quiet_NaN())});
  EXPECT_NEAR(x_now(), 0.1, 1e-6);
  const std::vector<std::string> told = input_->take_problems();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[0], HasSubstr("vmc://port: /VMC/Ext/Root/Pos: argument 2 is not finite"));
  EXPECT_THAT(told[1], HasSubstr("a second program, 127.0.0.1:"));
  EXPECT_THAT(input_->take_problems(), IsEmpty());
  EXPECT_EQ(input_->losses().malformed, 1U);
  EXPECT_EQ(input_->losses().strangers, 1U);
}

TEST_F(ByDatagrams, ATakenPortIsAnError) {
  const std::vector<LivePort> ports = {{"vmc://port", {"127.0.0.1", port_}, avatar_}};
  EXPECT_THROW(DatagramInput(ports, PoseShown::kLatest, 100ms), Error);
}

}  // namespace
}  // namespace vestige
