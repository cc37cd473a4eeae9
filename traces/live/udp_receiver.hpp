#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/base/host_port.hpp"

namespace vestige {

/// Hears datagrams on a port.
class UdpReceiver {
 public:
  /// Throws `Error` naming `name`: the host is none of this machine's addresses, the port is taken.
  UdpReceiver(const HostPort& place, const std::string& name);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// For poll.
  int descriptor() const { return socket_; }
  /// The next datagram that has come, if there is one; valid until the next call. Never waits.
  std::optional<std::span<const std::byte>> next();
  /// Datagrams that the system threw away because nobody took them in time.
  std::uint64_t overflowed() const { return overflowed_; }

 private:
  int socket_ = -1;
  std::uint32_t last_count_ = 0;
  std::uint64_t overflowed_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace vestige
