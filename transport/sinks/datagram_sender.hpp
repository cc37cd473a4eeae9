#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "traces/base/host_port.hpp"

namespace vestige {

/// A datagram that no later one corrects is sent so often, so far apart.
inline constexpr int kFinalTries = 3;
inline constexpr std::chrono::milliseconds kBetweenFinalTries(20);

/// Where datagrams go, and from which socket.
struct DatagramRoute {
  int socket = -1;
  sockaddr_storage host = {};
  socklen_t host_bytes = 0;
};

/// Sends datagrams to a host. A missing receiver is not an error: see `is_refused`.
class DatagramSender {
 public:
  /// Resolves a host name. IPv4 is preferred, because OSC programs listen there. `name` is that of the destination in
  /// messages: "osc://127.0.0.1:9000". Throws `Error` if the host is unknown.
  DatagramSender(const HostPort& place, std::string name);
  ~DatagramSender();
  DatagramSender(const DatagramSender&) = delete;
  DatagramSender& operator=(const DatagramSender&) = delete;

  const std::string& name() const { return name_; }
  /// For whoever sends there, too. The socket stays this object's.
  const DatagramRoute& route() const { return route_; }
  /// Throws `LinkLost` if there is no route to the host for now, and `Error` for faults that do not resolve themselves.
  void send(std::span<const std::byte> datagram);
  /// Whether there is a route to the host.
  bool has_route() const;
  /// Sends these datagrams, and waits 50 ms for the host's report that no program listens at this port. Most hosts send
  /// such a report; a firewall may block it.
  bool is_refused(std::span<const std::vector<std::byte>> probes);

  std::uint64_t bytes_sent() const { return bytes_sent_; }
  std::uint64_t datagrams_sent() const { return datagrams_sent_; }

 private:
  /// Returns a connected socket, on which the host's errors arrive. Returns a negative number, with errno set, if there
  /// is no route to the host.
  int connected_socket() const;
  void count(std::span<const std::byte> datagram);

  std::string name_;
  DatagramRoute route_;
  std::uint64_t bytes_sent_ = 0;
  std::uint64_t datagrams_sent_ = 0;
};

}  // namespace vestige
