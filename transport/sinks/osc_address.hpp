#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// The default address; a float of this name can be a parameter of a VRChat avatar.
inline constexpr std::string_view kOscAddressTemplate = "/avatar/parameters/vestige_{n}";

/// The value of a parameter for a level of 0 … 255: level / 255, the level, or whether it is not 0.
enum class OscValue : std::uint8_t { kFloat, kInteger, kBoolean };

/// The destination and the form of OSC messages.
struct OscOptions {
  std::string host;
  std::uint16_t port = 0;
  std::string address_template{kOscAddressTemplate};  ///< as for `osc_addresses`
  OscValue value = OscValue::kFloat;
  /// If nothing was sent for this time, a child process switches everything off.
  std::chrono::milliseconds ttl{200};
};

/// Reads `osc://HOST:PORT`, with or without a slash at the end; an IPv6 address stands in brackets. The other options
/// have their default values. Throws `UsageError` with --port.
OscOptions parse_osc_url(std::string_view url);

/// "osc://127.0.0.1:9000"
std::string osc_url(const OscOptions& options);

/// Returns the OSC address of each actuator. In the template, {n} is the actuator's number from 1, and {i} its number
/// from 0. {name} is its name, with _ for characters that an OSC address forbids. The bridge to bHaptics vests listens
/// to "/avatar/parameters/bOSC/v2/VestFront/{i}/self". Throws `UsageError` with --osc-address: not an address, an
/// unknown placeholder, or two actuators with one address.
std::vector<std::string> osc_addresses(std::string_view address_template,
                                       const std::vector<std::string>& actuator_names);

}  // namespace vestige
