#include "transport/sinks/osc_address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/host_port.hpp"

namespace vestige {

namespace {

/// Whether a character may occur in a part of an address between slashes (OSC 1.0, "OSC Messages").
bool may_stand_in_part(char c) {
  constexpr std::string_view kForbidden = " #*,/?[]{}";
  return c > ' ' && c <= '~' && kForbidden.find(c) == std::string_view::npos;
}

bool may_stand_in_address(char c) {
  return c == '/' || may_stand_in_part(c);
}

std::string part_of(const std::string& name) {
  std::string part;
  for (const char c : name) {
    const bool continues_a_character = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;  // UTF-8
    if (!continues_a_character) part += may_stand_in_part(c) ? c : '_';
  }
  return part;
}

std::string expand(std::string_view address_template, std::size_t index, const std::string& name) {
  std::string address;
  while (!address_template.empty()) {
    const std::size_t open = std::min(address_template.find('{'), address_template.size());
    address += address_template.substr(0, open);
    address_template.remove_prefix(open);
    if (address_template.empty()) break;
    const std::size_t length = std::min(address_template.find('}'), address_template.size() - 1) + 1;
    const std::string_view placeholder = address_template.substr(0, length);
    if (placeholder == "{n}") {
      address += std::to_string(index + 1);
    } else if (placeholder == "{i}") {
      address += std::to_string(index);
    } else if (placeholder == "{name}") {
      address += part_of(name);
    } else {
      throw UsageError("--osc-address", fmt::format("there is no placeholder '{}'", placeholder),
                       "choose from {n} (from 1), {i} (from 0) and {name}");
    }
    address_template.remove_prefix(length);
  }
  return address;
}

void check_address(const std::string& address) {
  constexpr std::size_t kMostBytes = 1000;  // an address must fit into a datagram
  const auto refuse = [&](const char* cause) {
    throw UsageError("--osc-address", fmt::format("'{}' {}", address, cause),
                     fmt::format("write an address like '{}'", kOscAddressTemplate));
  };
  if (!address.starts_with('/') || address.size() == 1)
    refuse("is not an OSC address, which begins with a slash and has a name after it");
  if (address.size() > kMostBytes) refuse("is too long");
  if (!std::ranges::all_of(address, may_stand_in_address))
    refuse("holds characters that an OSC address cannot hold: blanks, # * , ? [ ] { } or characters outside ASCII");
}

}  // namespace

OscOptions parse_osc_url(std::string_view url) {
  const std::string_view place = url.substr(0, url.size() - (url.ends_with('/') ? 1 : 0));
  const std::size_t host = url.find("://");
  if (host != std::string_view::npos && place.find('/', host + 3) != std::string_view::npos)
    throw UsageError("--port",
                     fmt::format("'{}' goes on after the port; --osc-address sets the names of the parameters", url),
                     "name a host and a port: osc://127.0.0.1:9000");
  HostPort parsed = parse_host_port(url, "osc", "--port");
  OscOptions options;
  options.host = std::move(parsed.host);
  options.port = parsed.port;
  return options;
}

std::string osc_url(const OscOptions& options) {
  return host_port_url("osc", {.host = options.host, .port = options.port});
}

std::vector<std::string> osc_addresses(std::string_view address_template,
                                       const std::vector<std::string>& actuator_names) {
  std::vector<std::string> addresses;
  addresses.reserve(actuator_names.size());
  std::map<std::string, std::size_t> number_of;
  for (std::size_t i = 0; i < actuator_names.size(); ++i) {
    const std::string& address = addresses.emplace_back(expand(address_template, i, actuator_names[i]));
    check_address(address);
    const auto [other, is_new] = number_of.emplace(address, i + 1);
    if (!is_new)
      throw UsageError(
          "--osc-address",
          fmt::format("actuators {} and {} would have the same address '{}'", other->second, i + 1, address),
          "put {n} or {i}, which differ for each actuator, into the template");
  }
  return addresses;
}

}  // namespace vestige
