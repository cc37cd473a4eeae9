#include <algorithm>
#include <cstring>
#include <string_view>

#include "detector/actuator_map.hpp"
#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"

// Whatever bytes an actuator map and its sidecar hold, reading it ends in an error that says something, or in a map in
// which every texel names an actuator that there is. The first two bytes say how long the sidecar is, which follows.

using vestige::fuzz::require;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  if (size < 2) return 0;
  const std::size_t said = std::size_t{data[0]} + 256 * std::size_t{data[1]};
  const std::size_t length = std::min(said, size - 2);
  const std::string_view sidecar(reinterpret_cast<const char*>(data + 2), length);
  const std::span<const std::byte> png(reinterpret_cast<const std::byte*>(data + 2 + length), size - 2 - length);
  try {
    const ActuatorMap map = parse_actuator_map(png, sidecar, "fuzz");
    for (const double u : {-1.0, 0.0, 0.3, 0.999999, 1.0, 1e300})
      for (const double v : {-0.5, 0.0, 0.5, 7.0}) static_cast<void>(map.at({u, v}));
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  return 0;
}
