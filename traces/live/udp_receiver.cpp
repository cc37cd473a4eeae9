#include "traces/live/udp_receiver.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostDatagramBytes = 65536;
/// Requested buffer size: a second of a busy source. The system grants what it allows.
constexpr int kReceiveBytes = 4 << 20;
/// A datagram that seems to have waited longer came while somebody set the system's clock.
constexpr std::chrono::seconds kLongestQueued(10);

std::chrono::nanoseconds since_1970(const timespec& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// Converts a time stamp of the system's clock, which counts from 1970.
Datagram::Clock::time_point steady_time(const timespec& stamp) {
  timespec now = {};
  ::clock_gettime(CLOCK_REALTIME, &now);
  const std::chrono::nanoseconds waited = since_1970(now) - since_1970(stamp);
  const bool is_credible = waited > std::chrono::seconds(0) && waited < kLongestQueued;
  return Datagram::Clock::now() - (is_credible ? waited : std::chrono::seconds(0));
}

}  // namespace

std::string to_string(const UdpAddress& address) {
  sockaddr_storage place = {};
  std::memcpy(&place, address.bytes.data(), address.bytes.size());
  const auto size = static_cast<socklen_t>(place.ss_family == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in));
  char host[NI_MAXHOST] = {};
  char port[NI_MAXSERV] = {};
  const int failure = ::getnameinfo(reinterpret_cast<const sockaddr*>(&place), size, host, sizeof host, port,
                                    sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
  return failure == 0 ? fmt::format("{}:{}", host, port) : "an unknown sender";
}

UdpReceiver::UdpReceiver(const HostPort& place, const std::string& name) : buffer_(kMostDatagramBytes) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(place.host.c_str(), std::to_string(place.port).c_str(), &hints, &found);
      error != 0)
    throw Error(name, fmt::format("the host '{}' cannot be resolved: {}", place.host, ::gai_strerror(error)),
                "name an address of this machine, or 0.0.0.0 for all");
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) throw Error(name, fmt::format("could not open a socket: {}", std::strerror(errno)), "");
  const int on = 1;
  ::setsockopt(socket_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  ::setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kReceiveBytes, sizeof kReceiveBytes);
  if (::bind(socket_, found->ai_addr, found->ai_addrlen) != 0) {
    const int error = errno;
    ::close(socket_);
    throw Error(name, fmt::format("could not listen: {}", std::strerror(error)),
                error == EADDRINUSE
                    ? "another program, or another person's source, listens there: end it, or choose another port"
                    : "name an address of this machine, or 0.0.0.0 for all");
  }
}

UdpReceiver::~UdpReceiver() {
  if (socket_ >= 0) ::close(socket_);
}

std::optional<Datagram> UdpReceiver::next() {
  Datagram datagram;
  iovec place = {.iov_base = buffer_.data(), .iov_len = buffer_.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(std::uint32_t)) + CMSG_SPACE(sizeof(timespec))] = {};
  msghdr message = {};
  ssize_t size = -1;
  do {
    message.msg_name = datagram.sender.bytes.data();
    message.msg_namelen = static_cast<socklen_t>(datagram.sender.bytes.size());
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    size = ::recvmsg(socket_, &message, 0);
  } while (size < 0 && errno == EINTR);
  if (size < 0) return {};
  std::optional<timespec> stamp;
  for (const cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPNS) std::memcpy(&stamp.emplace(), CMSG_DATA(part), sizeof(timespec));
    if (part->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, CMSG_DATA(part), sizeof count);
    overflowed_ += static_cast<std::uint32_t>(count - last_count_);  // the system's counter wraps around
    last_count_ = count;
  }
  datagram.arrived = stamp ? steady_time(*stamp) : Datagram::Clock::now();
  datagram.bytes = std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(size));
  return datagram;
}

}  // namespace vestige
