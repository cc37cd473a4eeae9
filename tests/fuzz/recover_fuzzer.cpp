#include <cstring>
#include <vector>

#include "tests/fuzz/require.hpp"
#include "traces/error.hpp"
#include "traces/recover.hpp"
#include "traces/trace_check.hpp"

// Whatever bytes a file holds, recovering it ends in an error that says something, or in a sound file, of which
// recovering loses nothing more.

using vestige::fuzz::require;

namespace {

std::vector<std::byte> recovered(std::span<const std::byte> bytes, vestige::Recovery& recovery) {
  std::vector<std::byte> out;
  const vestige::mcap::MemorySource source(bytes);
  recovery = vestige::recover_mcap(
      source, [&](std::span<const std::byte> more) { out.insert(out.end(), more.begin(), more.end()); },
      [](double) { return true; });
  return out;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  Recovery recovery;
  std::vector<std::byte> mended;
  try {
    mended = recovered({reinterpret_cast<const std::byte*>(data), size}, recovery);
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
    return 0;
  }
  const mcap::MemorySource source(mended);
  const TraceCheck check = check_trace(source, [](double) { return true; });
  require(check.container.has_footer && check.container.damaged_chunks == 0, "what is recovered is sound");
  if (recovery.messages == 0) return 0;
  Recovery again;
  static_cast<void>(recovered(mended, again));
  require(again.messages == recovery.messages, "recovering what was recovered loses nothing");
  return 0;
}
