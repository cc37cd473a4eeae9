#include "transport/sinks/osc_sink.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lo/lo.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <map>

#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// A UDP socket of this machine, on a port that nobody else has.
class Listener {
 public:
  explicit Listener(int family = AF_INET) : socket_(::socket(family, SOCK_DGRAM, 0)) {
    sockaddr_in ipv4 = {};
    ipv4.sin_family = AF_INET;
    ipv4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockaddr_in6 ipv6 = {};
    ipv6.sin6_family = AF_INET6;
    ipv6.sin6_addr = in6addr_loopback;
    const bool is_ipv4 = family == AF_INET;
    auto* const address = is_ipv4 ? reinterpret_cast<sockaddr*>(&ipv4) : reinterpret_cast<sockaddr*>(&ipv6);
    socklen_t bytes = is_ipv4 ? sizeof(ipv4) : sizeof(ipv6);
    opened_ = ::bind(socket_, address, bytes) == 0 && ::getsockname(socket_, address, &bytes) == 0;
    port_ = ntohs(is_ipv4 ? ipv4.sin_port : ipv6.sin6_port);
    const timeval patience = {10, 0};  // a datagram that never comes fails the test
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  bool opened() const { return opened_; }
  std::uint16_t port() const { return port_; }

  std::string receive() const {
    std::string datagram(65536, '\0');
    const ssize_t size = ::recv(socket_, datagram.data(), datagram.size(), 0);
    datagram.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return datagram;
  }

  /// How many bytes wait to be received.
  std::size_t waiting() const {
    int bytes = 0;
    return ::ioctl(socket_, FIONREAD, &bytes) == 0 ? static_cast<std::size_t>(bytes) : 0;
  }

 private:
  int socket_;
  bool opened_ = false;
  std::uint16_t port_ = 0;
};

using Parameters = std::map<std::string, std::string>;

/// What a datagram says, as another program decodes it: "f 0.5" at each address.
Parameters decode(std::string datagram) {
  const lo_server server = lo_server_new(nullptr, nullptr);
  Parameters parameters;
  const auto take = [](const char* path, const char* types, lo_arg** values, int, lo_message, void* out) {
    std::string text = types;
    if (*types == 'f') text += " " + std::to_string(values[0]->f);
    if (*types == 'i') text += " " + std::to_string(values[0]->i);
    static_cast<Parameters*>(out)->emplace(path, text);
    return 0;
  };
  lo_server_add_method(server, nullptr, nullptr, take, &parameters);
  lo_server_dispatch_data(server, datagram.data(), datagram.size());
  lo_server_free(server);
  return parameters;
}

OscOptions local(std::uint16_t port, const std::string& address_template = "/a/{n}",
                 OscValue value = OscValue::kFloat) {
  return {"127.0.0.1", port, address_template, value};
}

std::string refusal(const std::string& url) {
  try {
    parse_osc_url(url);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

std::string template_refusal(const std::string& address_template, const std::vector<std::string>& names) {
  try {
    osc_addresses(address_template, names);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(OscUrl, NamesAHostAndAPort) {
  EXPECT_EQ(parse_osc_url("osc://192.168.1.20:9000").host, "192.168.1.20");
  EXPECT_EQ(parse_osc_url("osc://192.168.1.20:9000").port, 9000);
  EXPECT_EQ(parse_osc_url("osc://localhost:65535/").host, "localhost");
  EXPECT_EQ(parse_osc_url("osc://[fe80::1%eth0]:1").host, "fe80::1%eth0");
  for (const char* url : {"osc://vest.local:9000", "osc://[::1]:9000"}) EXPECT_EQ(osc_url(parse_osc_url(url)), url);
}

TEST(OscUrl, SaysWhatIsWrongWithIt) {
  EXPECT_THAT(refusal("udp://a:1"), AllOf(HasSubstr("--port"), HasSubstr("osc://127.0.0.1:9000")));
  EXPECT_THAT(refusal("osc://"), HasSubstr("no host"));
  EXPECT_THAT(refusal("osc://:9000"), HasSubstr("no host"));
  EXPECT_THAT(refusal("osc://[]:9000"), HasSubstr("no host"));
  EXPECT_THAT(refusal("osc://host"), HasSubstr("no port"));
  EXPECT_THAT(refusal("osc://[::1]"), HasSubstr("no port"));
  EXPECT_THAT(refusal("osc://[::1]9000"), HasSubstr("no port"));
  EXPECT_THAT(refusal("osc://[::1:9000"), HasSubstr("no closing bracket"));
  EXPECT_THAT(refusal("osc://::1:9000"), HasSubstr("brackets"));
  for (const char* port : {"", "0", "65536", "-1", "9000x", "http", " 9000"})
    EXPECT_THAT(refusal(std::string("osc://host:") + port), HasSubstr("from 1 to 65535")) << port;
  EXPECT_THAT(refusal("osc://host:9000/avatar"), HasSubstr("--osc-address"));
}

TEST(OscAddresses, NumberOrNameTheActuators) {
  EXPECT_THAT(osc_addresses(kOscAddressTemplate, {"chest", "back"}),
              ElementsAre("/avatar/parameters/vestige_1", "/avatar/parameters/vestige_2"));
  EXPECT_THAT(
      osc_addresses("/avatar/parameters/bOSC/v2/VestFront/{i}/self", {"chest", "back"}),
      ElementsAre("/avatar/parameters/bOSC/v2/VestFront/0/self", "/avatar/parameters/bOSC/v2/VestFront/1/self"));
  EXPECT_THAT(osc_addresses("/{n}/{name}{i}", {"chest left/top",
                                               "R\xc3\xbc"
                                               "cken*"}),
              ElementsAre("/1/chest_left_top0", "/2/R_cken_1"));
}

TEST(OscAddresses, AreRefusedWhereTheyAreNoneOrNotOfOneActuator) {
  EXPECT_THAT(template_refusal("/a/{x}", {"a"}),
              AllOf(HasSubstr("--osc-address"), HasSubstr("'{x}'"), HasSubstr("{n}")));
  EXPECT_THAT(template_refusal("/a/{n", {"a"}), HasSubstr("'{n'"));
  EXPECT_THAT(template_refusal("/a/n}", {"a"}), HasSubstr("cannot hold"));
  EXPECT_THAT(template_refusal("a/{n}", {"a"}), HasSubstr("begins with a slash"));
  EXPECT_THAT(template_refusal("/", {"a"}), HasSubstr("begins with a slash"));
  EXPECT_THAT(template_refusal("", {"a"}), HasSubstr("begins with a slash"));
  EXPECT_THAT(template_refusal("/a b{n}", {"a"}), HasSubstr("blanks"));
  EXPECT_THAT(template_refusal("/" + std::string(1000, 'x'), {"a"}), HasSubstr("too long"));
  EXPECT_THAT(template_refusal("/vest", {"a", "b"}), HasSubstr("actuators 1 and 2"));
  EXPECT_THAT(template_refusal("/{name}", {"arm 1", "leg", "arm#1"}), HasSubstr("actuators 1 and 3"));
}

TEST(OscSink, SendsAFrameAsOneBundleWithAllValues) {
  const Listener listener;
  OscSink sink(local(listener.port()), {"left", "right"});
  sink.send({0, {255, 51}}, 0);
  using namespace std::string_literals;
  // OSC 1.0 by hand: a bundle to be obeyed at once, of two messages of 16 bytes each.
  EXPECT_EQ(listener.receive(),
            "#bundle\0\0\0\0\0\0\0\0\1"
            "\0\0\0\x10/a/1\0\0\0\0,f\0\0\x3f\x80\0\0"
            "\0\0\0\x10/a/2\0\0\0\0,f\0\0\x3e\x4c\xcc\xcd"s);
  EXPECT_EQ(sink.bytes_sent(), 56U);
  sink.send({1, {255, 51}}, 1);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/a/1", "f 1.000000"), Pair("/a/2", "f 0.200000")))
      << "values that did not change are sent again";
}

TEST(OscSink, SwitchesAllOffAndIgnoresLevelsThatItHasNoActuatorFor) {
  const Listener listener;
  OscSink sink(local(listener.port()), {"left", "right"});
  sink.send({0, {0, 255, 255}}, 0);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/a/1", "f 0.000000"), Pair("/a/2", "f 1.000000")));
  sink.send({0, {255}}, 1);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/a/1", "f 1.000000"), Pair("/a/2", "f 0.000000")));
  sink.send_off(2);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/a/1", "f 0.000000"), Pair("/a/2", "f 0.000000")));
}

TEST(OscSink, SendsWholeNumbersOrSwitchesWhereAskedTo) {
  const Listener listener;
  OscSink numbers(local(listener.port(), "/{name}", OscValue::kInteger), {"x", "y"});
  numbers.send({0, {0, 200}}, 0);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/x", "i 0"), Pair("/y", "i 200")));
  OscSink switches(local(listener.port(), "/{name}", OscValue::kBoolean), {"x", "y"});
  switches.send({0, {0, 1}}, 0);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/x", "F"), Pair("/y", "T")));
}

TEST(OscSink, SplitsAFrameThatWouldNotFitIntoAPacket) {
  const Listener listener;
  OscSink sink(local(listener.port(), "/avatar/parameters/vestige_{n}"), std::vector<std::string>(200, "a"));
  sink.send({0, std::vector<std::uint8_t>(200, 255)}, 0);
  Parameters all;
  std::size_t bytes = 0;
  std::size_t datagrams = 0;
  while (bytes < sink.bytes_sent()) {
    const std::string datagram = listener.receive();
    ASSERT_FALSE(datagram.empty());
    EXPECT_LE(datagram.size(), 1400U);
    bytes += datagram.size();
    ++datagrams;
    all.merge(decode(datagram));
  }
  EXPECT_EQ(all.size(), 200U);
  EXPECT_GT(datagrams, 5U);
  EXPECT_LT(datagrams, 10U) << "packets are filled";
}

TEST(OscSink, ReachesIpv6AndNames) {
  const Listener ipv6(AF_INET6);
  if (!ipv6.opened()) GTEST_SKIP() << "this machine has no IPv6; nothing was tested here";
  OscOptions options = parse_osc_url("osc://[::1]:" + std::to_string(ipv6.port()));
  OscSink sink(options, {"a"});
  EXPECT_EQ(sink.name(), "osc://[::1]:" + std::to_string(ipv6.port()));
  sink.send({0, {255}}, 0);
  EXPECT_THAT(decode(ipv6.receive()), ElementsAre(Pair("/avatar/parameters/vestige_1", "f 1.000000")));

  const Listener ipv4;
  OscSink(parse_osc_url("osc://localhost:" + std::to_string(ipv4.port())), {"a"}).send({0, {0}}, 0);
  EXPECT_FALSE(ipv4.receive().empty());
}

TEST(OscSink, DoesNotMindThatNobodyListens) {
  std::uint16_t port = 0;
  {
    const Listener gone;
    port = gone.port();
  }
  OscSink sink(local(port), {"a"});
  for (std::uint8_t i = 0; i < 20; ++i) EXPECT_NO_THROW(sink.send({0, {i}}, i));
  EXPECT_TRUE(sink.reconnect());
  EXPECT_TRUE(sink.is_refused());
  OscSink of_two_datagrams({"127.0.0.1", port}, std::vector<std::string>(40, "motor"));
  EXPECT_TRUE(of_two_datagrams.is_refused());
}

TEST(OscSink, AHostThatNobodyKnowsIsAnErrorWithItsName) {
  try {
    const OscSink sink({"no.such.host.invalid", 9000}, {"a"});
    FAIL() << "was found";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("osc://no.such.host.invalid:9000"), HasSubstr("not known")));
  }
}

/// In a process with a network of its own, where even this machine is out of reach until "lo" is switched on.
int lose_and_find_the_link() {
  constexpr int kNotAllowed = 77;
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return kNotAllowed;
  OscSink sink(local(9000), {"a"});
  try {
    sink.send({0, {255}}, 0);
    return 1;
  } catch (const LinkLost&) {
  }
  if (sink.reconnect()) return 2;
  ifreq loopback = {};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP;
  const int control = ::socket(AF_INET, SOCK_DGRAM, 0);
  if (::ioctl(control, SIOCSIFFLAGS, &loopback) != 0) return 3;
  if (!sink.reconnect()) return 4;
  sink.send({0, {255}}, 0);
  return 0;
}

TEST(OscSink, SaysThatTheLinkIsLostWithoutANetworkAndFindsItAgain) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(lose_and_find_the_link());
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "no network may be made here; nothing was tested";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// A process that leaves an actuator on, and then does `end` to itself.
template <typename End>
pid_t leave_on(std::uint16_t port, End end) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  {
    OscOptions options = local(port);
    options.ttl = std::chrono::seconds(1);
    OscSink sink(options, {"a"});
    sink.send({0, {255}}, 0);
    end();
    sink.send({0, {51}}, 1);
    sink.send_off(2);
  }
  ::_exit(0);
}

const Parameters kOff = {{"/a/1", "f 0.000000"}};
const Parameters kFull = {{"/a/1", "f 1.000000"}};

TEST(OscSink, EvenAProgramThatIsKilledLeavesNothingOn) {
  const Listener listener;
  const pid_t child = leave_on(listener.port(), [] { ::raise(SIGKILL); });
  EXPECT_EQ(decode(listener.receive()), kFull);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decode(listener.receive()), kOff);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(OscSink, ASinkThatIsGivenUpLeavesNothingOn) {
  const Listener listener;
  { OscSink(local(listener.port()), {"a"}).send({0, {255}}, 0); }
  EXPECT_EQ(decode(listener.receive()), kFull);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decode(listener.receive()), kOff);
}

TEST(OscSink, AProgramThatIsHeldUpLeavesNothingOnMeanwhile) {
  const Listener listener;
  const pid_t child = leave_on(listener.port(), [] { ::raise(SIGSTOP); });
  EXPECT_EQ(decode(listener.receive()), kFull);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decode(listener.receive()), kOff);
  ::kill(child, SIGCONT);
  EXPECT_THAT(decode(listener.receive()), ElementsAre(Pair("/a/1", "f 0.200000")));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decode(listener.receive()), kOff);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(listener.waiting(), 0U) << "a program that ended well needs nobody to switch off for it";
}

TEST(OscSink, IsUnderstoodByOscdump) {
  const test::TemporaryFolder folder;
  const std::string output = (folder / "dump").string();
  std::uint16_t port = 0;
  {
    const Listener free;
    port = free.port();
  }
  const pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(output.c_str(), "w", stdout) == nullptr) ::_exit(1);
    const std::string number = std::to_string(port);
    ::execlp("oscdump", "oscdump", "-L", number.c_str(), nullptr);
    ::_exit(127);
  }
  ASSERT_GT(child, 0);
  OscSink sink({"127.0.0.1", port}, {"a", "b"});
  const auto dumped = [&] { return std::filesystem::exists(output) ? read_text_file(output) : std::string(); };
  // It listens at some time after its start: frames go on until it does.
  int status = 0;
  bool ended = false;
  while (!ended && dumped().find("vestige_2") == std::string::npos) {
    sink.send({0, {128, 255}}, 0);
    ::usleep(10000);
    ended = ::waitpid(child, &status, WNOHANG) == child;
  }
  ASSERT_FALSE(ended) << "oscdump ended by itself, with status " << status << "; is liblo-tools installed?";
  ::kill(child, SIGTERM);
  ::waitpid(child, &status, 0);
  EXPECT_THAT(dumped(), AllOf(HasSubstr("/avatar/parameters/vestige_1 f 0.501961\n"),
                              HasSubstr("/avatar/parameters/vestige_2 f 1.000000\n")));
}

}  // namespace
}  // namespace vestige
