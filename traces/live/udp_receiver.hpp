#pragma once

#include <netinet/in.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/base/host_port.hpp"

namespace vestige {

/// The socket that a datagram came from.
struct UdpAddress {
  std::array<std::byte, sizeof(sockaddr_in6)> bytes = {};  ///< as the system gives it, then zeros

  bool operator==(const UdpAddress&) const = default;
};

/// Returns "127.0.0.1:39539".
std::string to_string(const UdpAddress& address);

struct Datagram {
  using Clock = std::chrono::steady_clock;

  std::span<const std::byte> bytes;
  /// When the system received it, however long it then waited to be read. The system's time stamp is converted by the
  /// difference of both clocks when it is read.
  Clock::time_point arrived = {};
  UdpAddress sender = {};
};

/// Receives datagrams on a port.
class UdpReceiver {
 public:
  /// Throws `Error` with `name` if the host is not an address of this machine, or the port is taken.
  UdpReceiver(const HostPort& place, const std::string& name);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// The descriptor for `poll`.
  int descriptor() const { return socket_; }
  /// Returns the next datagram that has arrived, if there is one; its bytes are valid until the next call. Never waits.
  std::optional<Datagram> next();
  /// Number of datagrams that the system discarded because they were not read in time.
  std::uint64_t overflowed() const { return overflowed_; }

 private:
  int socket_ = -1;
  std::uint32_t last_count_ = 0;
  std::uint64_t overflowed_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace vestige
