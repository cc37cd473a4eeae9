#include <cmath>
#include <cstring>

#include "detector/contacts_csv.hpp"
#include "tests/fuzz/require.hpp"
#include "traces/colliders.hpp"
#include "traces/error.hpp"

// Whatever a CSV file holds, reading it as colliders or as contacts ends in an error that says something, or in
// positions that are finite.

using vestige::fuzz::require;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  const auto path = fuzz::in_a_file({reinterpret_cast<const std::byte*>(data), size});
  try {
    const auto colliders = read_collider_csv(path);
    const TimeSpan span = colliders->span_s();
    require(span.first_s <= span.last_s, "time does not run back");
    std::vector<ColliderSample> samples;
    for (const double part : {0.0, 0.4, 1.0})
      colliders->sample(span.first_s + part * (span.last_s - span.first_s), samples);
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  try {
    static_cast<void>(read_contacts_csv(path));
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  return 0;
}
