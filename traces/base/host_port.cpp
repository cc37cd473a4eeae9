#include "traces/base/host_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "traces/base/error.hpp"

namespace vestige {

HostPort parse_host_port(std::string_view url, std::string_view scheme, std::string_view flag,
                         std::uint16_t default_port) {
  const auto refuse = [&](const std::string& cause) {
    return UsageError(flag, fmt::format("'{}' {}", url, cause),
                      fmt::format("name a host and a port: {0}://127.0.0.1:{1}, {0}://[::1]:{1}", scheme,
                                  default_port == 0 ? 9000 : default_port));
  };
  const std::string beginning = fmt::format("{}://", scheme);
  if (!url.starts_with(beginning)) throw refuse("does not begin with " + beginning);
  std::string_view rest = url.substr(beginning.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  if (rest.find('/') != std::string_view::npos) throw refuse("continues after the port");
  std::string_view host;
  if (rest.starts_with('[')) {
    const std::size_t close = rest.find(']');
    if (close == std::string_view::npos) throw refuse("has no closing bracket");
    host = rest.substr(1, close - 1);
    rest.remove_prefix(close + 1);
  } else {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    host = rest.substr(0, colon);
    rest.remove_prefix(colon);
    if (rest.find(':', 1) != std::string_view::npos)
      throw refuse("has more than one colon; an IPv6 address must be in brackets");
  }
  if (host.empty()) throw refuse("has no host");
  HostPort place{.host = std::string(host), .port = default_port};
  if (rest.empty() && default_port != 0) return place;
  if (!rest.starts_with(':')) throw refuse("has no port");
  rest.remove_prefix(1);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), place.port);
  if (error != std::errc() || end != rest.data() + rest.size() || place.port == 0)
    throw refuse(fmt::format("has the port '{}', which is not a number from 1 to 65535", rest));
  return place;
}

std::string host_port_url(std::string_view scheme, const HostPort& place) {
  const bool is_ipv6 = place.host.find(':') != std::string::npos;
  return fmt::format("{}://{}:{}", scheme, is_ipv6 ? "[" + place.host + "]" : place.host, place.port);
}

}  // namespace vestige
