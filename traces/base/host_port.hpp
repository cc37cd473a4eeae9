#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vestige {

struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};

/// Reads `SCHEME://HOST:PORT`, with or without a slash at the end; an IPv6 address stands in brackets. The port may be
/// left out if `default_port` is not 0. Throws `UsageError` naming `flag`.
HostPort parse_host_port(std::string_view url, std::string_view scheme, std::string_view flag,
                         std::uint16_t default_port = 0);

/// "osc://127.0.0.1:9000"
std::string host_port_url(std::string_view scheme, const HostPort& place);

}  // namespace vestige
