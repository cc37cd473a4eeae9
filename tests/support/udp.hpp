#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vestige::test {

/// Sends datagrams to a port of this machine.
class UdpSender {
 public:
  explicit UdpSender(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    place_.sin_family = AF_INET;
    place_.sin_port = htons(port);
    place_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~UdpSender() { ::close(socket_); }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  void send(std::span<const std::byte> datagram) const {
    ::sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&place_), sizeof place_);
  }

 private:
  int socket_;
  sockaddr_in place_ = {};
};

/// Returns a port on which no program listens now.
inline std::uint16_t free_udp_port() {
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in place = {};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::bind(probe, reinterpret_cast<const sockaddr*>(&place), sizeof place);
  socklen_t bytes = sizeof place;
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&place), &bytes);
  ::close(probe);
  return ntohs(place.sin_port);
}

}  // namespace vestige::test
