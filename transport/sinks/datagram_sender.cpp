#include "transport/sinks/datagram_sender.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "transport/actuator_sink.hpp"

namespace vestige {

namespace {

/// Whether an error says that there is no route to the host now, but may be one later.
bool is_passing(int error_number) {
  return error_number == ENETUNREACH || error_number == EHOSTUNREACH || error_number == ENETDOWN ||
         error_number == ENOBUFS;
}

}  // namespace

DatagramSender::DatagramSender(const HostPort& place, std::string name) : name_(std::move(name)) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(place.host.c_str(), std::to_string(place.port).c_str(), &hints, &found);
      error != 0)
    throw Error(name_, fmt::format("the host '{}' is not known: {}", place.host, ::gai_strerror(error)),
                fmt::format("check the host's name, or give its address: {}192.168.1.20:{}",
                            name_.substr(0, name_.find("//") + 2), place.port));
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  const addrinfo* chosen = found;
  while (chosen != nullptr && chosen->ai_family != AF_INET) chosen = chosen->ai_next;
  if (chosen == nullptr) chosen = found;
  std::memcpy(&route_.host, chosen->ai_addr, chosen->ai_addrlen);
  route_.host_bytes = chosen->ai_addrlen;
  // Never connected, so a missing receiver does not cause an error in the next frame.
  route_.socket = ::socket(chosen->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (route_.socket < 0) throw Error(name_, fmt::format("could not open a socket: {}", std::strerror(errno)), "");
  const int allowed = 1;
  ::setsockopt(route_.socket, SOL_SOCKET, SO_BROADCAST, &allowed, sizeof(allowed));
}

DatagramSender::~DatagramSender() {
  if (route_.socket >= 0) ::close(route_.socket);
}

void DatagramSender::send(std::span<const std::byte> datagram) {
  const auto* const host = reinterpret_cast<const sockaddr*>(&route_.host);
  while (::sendto(route_.socket, datagram.data(), datagram.size(), MSG_NOSIGNAL, host, route_.host_bytes) < 0) {
    const int error = errno;
    if (error == EINTR) continue;
    const std::string cause = fmt::format("could not send: {}", std::strerror(error));
    if (is_passing(error)) throw LinkLost(name_, cause, "check the network");
    throw Error(name_, cause, "check the address, and that no firewall blocks it");
  }
  count(datagram);
}

bool DatagramSender::has_route() const {
  return Descriptor(connected_socket()).value() >= 0;
}

bool DatagramSender::is_refused(std::span<const std::vector<std::byte>> probes) {
  constexpr int kPatience_ms = 50;
  const Descriptor socket(connected_socket());
  if (socket.value() < 0) return false;
  for (const std::vector<std::byte>& datagram : probes) {
    if (::send(socket.value(), datagram.data(), datagram.size(), MSG_NOSIGNAL) < 0)
      return errno == ECONNREFUSED;  // the report about a datagram before
    count(datagram);
  }
  pollfd answer{.fd = socket.value(), .events = POLLIN, .revents = 0};
  if (::poll(&answer, 1, kPatience_ms) <= 0) return false;
  char ignored = 0;
  return ::recv(socket.value(), &ignored, 1, MSG_DONTWAIT) < 0 && errno == ECONNREFUSED;
}

int DatagramSender::connected_socket() const {
  // Connecting a datagram socket sends nothing: it only looks up a route to the host.
  Descriptor made(::socket(route_.host.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (made.value() < 0 ||
      ::connect(made.value(), reinterpret_cast<const sockaddr*>(&route_.host), route_.host_bytes) != 0)
    return -1;
  return made.release();
}

void DatagramSender::count(std::span<const std::byte> datagram) {
  bytes_sent_ += datagram.size();
  ++datagrams_sent_;
}

}  // namespace vestige
