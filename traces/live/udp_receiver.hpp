#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/base/host_port.hpp"

namespace vestige {

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
  /// Returns the next datagram that has arrived, if there is one; valid until the next call. Never waits.
  std::optional<std::span<const std::byte>> next();
  /// Number of datagrams that the system discarded because they were not read in time.
  std::uint64_t overflowed() const { return overflowed_; }

 private:
  int socket_ = -1;
  std::uint32_t last_count_ = 0;
  std::uint64_t overflowed_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace vestige
