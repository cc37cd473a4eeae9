#include "transport/sinks/osc_sink.hpp"

#include <fmt/format.h>
#include <lo/lo.h>
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>

#include "traces/base/descriptor.hpp"

namespace vestige {

namespace {

/// An Ethernet packet of 1500 bytes, less the headers of IPv6, UDP and a tunnel.
constexpr std::size_t kMostDatagramBytes = 1400;

struct FreeBundle {
  void operator()(void* bundle) const { lo_bundle_free_recursive(bundle); }
};
using Bundle = std::unique_ptr<void, FreeBundle>;

Bundle new_bundle() {
  constexpr lo_timetag kImmediately = {0, 1};
  return Bundle(lo_bundle_new(kImmediately));
}

lo_message new_message(OscValue value, std::uint8_t level) {
  const lo_message message = lo_message_new();
  switch (value) {
    case OscValue::kFloat:
      lo_message_add_float(message, static_cast<float>(level) / 255.0F);
      break;
    case OscValue::kInteger:
      lo_message_add_int32(message, level);
      break;
    case OscValue::kBoolean:
      level != 0 ? lo_message_add_true(message) : lo_message_add_false(message);
      break;
  }
  return message;
}

/// Whether an error says that there is no route to the host now, but may be one later.
bool is_passing(int error_number) {
  return error_number == ENETUNREACH || error_number == EHOSTUNREACH || error_number == ENETDOWN ||
         error_number == ENOBUFS;
}

}  // namespace

OscSink::OscSink(OscOptions options, const std::vector<std::string>& actuator_names)
    : options_(std::move(options)), addresses_(osc_addresses(options_.address_template, actuator_names)) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(options_.host.c_str(), std::to_string(options_.port).c_str(), &hints, &found);
      error != 0)
    throw Error(name(), fmt::format("the host '{}' is not known: {}", options_.host, ::gai_strerror(error)),
                "check the host's name, or give its address: osc://192.168.1.20:9000");
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  const addrinfo* chosen = found;
  while (chosen != nullptr && chosen->ai_family != AF_INET) chosen = chosen->ai_next;
  if (chosen == nullptr) chosen = found;
  std::memcpy(&route_.host, chosen->ai_addr, chosen->ai_addrlen);
  route_.host_bytes = chosen->ai_addrlen;
  // Never connected, so a missing receiver does not cause an error in the next frame.
  route_.socket = ::socket(chosen->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (route_.socket < 0) throw Error(name(), fmt::format("could not open a socket: {}", std::strerror(errno)), "");
  const int allowed = 1;
  ::setsockopt(route_.socket, SOL_SOCKET, SO_BROADCAST, &allowed, sizeof(allowed));
  watchdog_.emplace(route_, datagrams_of({}), options_.ttl);
}

OscSink::~OscSink() {
  if (route_.socket >= 0) ::close(route_.socket);
}

void OscSink::send(const ActuatorFrame& frame, std::uint8_t) {
  watchdog_->note_on();
  send_levels(frame.duty);
}

void OscSink::send_off(std::uint8_t) {
  for (int i = 0; i < 3; ++i) {  // no later frame corrects a lost one
    if (i != 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    send_levels({});
  }
  watchdog_->note_off();
}

void OscSink::send_levels(std::span<const std::uint8_t> level) {
  for (const std::vector<std::byte>& datagram : datagrams_of(level)) send_datagram(datagram);
}

std::vector<std::vector<std::byte>> OscSink::datagrams_of(std::span<const std::uint8_t> level) const {
  std::vector<std::vector<std::byte>> datagrams;
  Bundle bundle = new_bundle();
  const auto end_bundle = [&] {
    std::size_t size = lo_bundle_length(bundle.get());
    lo_bundle_serialise(bundle.get(), datagrams.emplace_back(size).data(), &size);
  };
  for (std::size_t i = 0; i < addresses_.size(); ++i) {
    const char* const address = addresses_[i].c_str();
    const lo_message message = new_message(options_.value, i < level.size() ? level[i] : std::uint8_t{0});
    const std::size_t more = sizeof(std::uint32_t) + lo_message_length(message, address);
    if (lo_bundle_count(bundle.get()) > 0 && lo_bundle_length(bundle.get()) + more > kMostDatagramBytes) {
      end_bundle();
      bundle = new_bundle();
    }
    lo_bundle_add_message(bundle.get(), address, message);
  }
  if (lo_bundle_count(bundle.get()) > 0) end_bundle();
  return datagrams;
}

void OscSink::send_datagram(std::span<const std::byte> bytes) {
  // liblo only encodes. Its own sending does not support IPv6, and uses the first address of a name.
  const auto* const host = reinterpret_cast<const sockaddr*>(&route_.host);
  while (::sendto(route_.socket, bytes.data(), bytes.size(), MSG_NOSIGNAL, host, route_.host_bytes) < 0) {
    const int error = errno;
    if (error == EINTR) continue;
    const std::string cause = fmt::format("could not send: {}", std::strerror(error));
    if (is_passing(error)) throw LinkLost(name(), cause, "check the network");
    throw Error(name(), cause, "check the address, and that no firewall blocks it");
  }
  count(bytes);
}

void OscSink::count(std::span<const std::byte> datagram) {
  bytes_sent_ += datagram.size();
  ++datagrams_sent_;
}

bool OscSink::reconnect() {
  return Descriptor(connected_socket()).value() >= 0;
}

bool OscSink::is_refused() {
  constexpr int kPatience_ms = 50;
  const Descriptor probe(connected_socket());
  if (probe.value() < 0) return false;
  for (const std::vector<std::byte>& datagram : datagrams_of({})) {
    if (::send(probe.value(), datagram.data(), datagram.size(), MSG_NOSIGNAL) < 0) return false;
    count(datagram);
  }
  pollfd answer{.fd = probe.value(), .events = POLLIN, .revents = 0};
  if (::poll(&answer, 1, kPatience_ms) <= 0) return false;
  char ignored = 0;
  return ::recv(probe.value(), &ignored, 1, MSG_DONTWAIT) < 0 && errno == ECONNREFUSED;
}

int OscSink::connected_socket() const {
  // Connecting a datagram socket sends nothing: it only looks up a route to the host.
  Descriptor made(::socket(route_.host.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (made.value() < 0 ||
      ::connect(made.value(), reinterpret_cast<const sockaddr*>(&route_.host), route_.host_bytes) != 0)
    return -1;
  return made.release();
}

}  // namespace vestige
