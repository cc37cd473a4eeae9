#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// A float of this name can be a parameter of a VRChat avatar.
inline constexpr std::string_view kOscAddressTemplate = "/avatar/parameters/vestige_{n}";

/// What a parameter carries for a level of 0 … 255: level / 255, the level, or whether it is not 0.
enum class OscValue : std::uint8_t { kFloat, kInteger, kBoolean };

/// Where OSC goes, and how it looks.
struct OscOptions {
  std::string host;
  std::uint16_t port = 0;
  std::string address_template{kOscAddressTemplate};  ///< as for `osc_addresses`
  OscValue value = OscValue::kFloat;
};

/// Reads `osc://HOST:PORT`, with or without a slash at the end; an IPv6 address stands in brackets. The rest of the
/// options is default. Throws `UsageError` naming --port.
OscOptions parse_osc_url(std::string_view url);

/// "osc://127.0.0.1:9000"
std::string osc_url(const OscOptions& options);

/// The OSC address of each actuator. In the template {n} stands for its number from 1, {i} for the same from 0, and
/// {name} for its name, with _ for what an OSC address forbids. "/avatar/parameters/bOSC/v2/VestFront/{i}/self" is what
/// the bridge to bHaptics vests listens to. Throws `UsageError` naming --osc-address: no address, a placeholder that
/// there is not, or two actuators with one address.
std::vector<std::string> osc_addresses(std::string_view address_template,
                                       const std::vector<std::string>& actuator_names);

}  // namespace vestige
