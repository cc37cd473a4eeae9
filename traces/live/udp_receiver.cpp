#include "traces/live/udp_receiver.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostDatagramBytes = 65536;
/// Requested buffer size: a second of a busy source. The system grants what it allows.
constexpr int kReceiveBytes = 4 << 20;

}  // namespace

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
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kReceiveBytes, sizeof kReceiveBytes);
  if (::bind(socket_, found->ai_addr, found->ai_addrlen) != 0) {
    const int error = errno;
    ::close(socket_);
    throw Error(name, fmt::format("could not listen: {}", std::strerror(error)),
                error == EADDRINUSE
                    ? "another program, or the --live of another person, listens there: end it, or choose another port"
                    : "name an address of this machine, or 0.0.0.0 for all");
  }
}

UdpReceiver::~UdpReceiver() {
  if (socket_ >= 0) ::close(socket_);
}

std::optional<std::span<const std::byte>> UdpReceiver::next() {
  iovec place = {.iov_base = buffer_.data(), .iov_len = buffer_.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(std::uint32_t))] = {};
  msghdr message = {};
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  ssize_t size = -1;
  do {
    size = ::recvmsg(socket_, &message, 0);
  } while (size < 0 && errno == EINTR);
  if (size < 0) return {};
  for (const cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, CMSG_DATA(part), sizeof count);
    overflowed_ += static_cast<std::uint32_t>(count - last_count_);  // the system's counter wraps around
    last_count_ = count;
  }
  return std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(size));
}

}  // namespace vestige
