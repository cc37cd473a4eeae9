#include <cstring>
#include <vector>

#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/repair/recover.hpp"
#include "traces/repair/trace_check.hpp"

// Whatever bytes a file holds, recovering it ends in an error that says something, or in a sound file, of which
// recovering loses nothing more; and messages that can be read from the damaged file and are not in the recovered one
// are admitted to be lost.

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

/// How many messages a reader delivers that verifies every CRC and steps over damage.
std::uint64_t readable_messages(std::span<const std::byte> bytes) {
  using vestige::mcap::Opcode;
  std::uint64_t messages = 0;
  try {
    const vestige::mcap::MemorySource source(bytes);
    vestige::mcap::StreamReader reader(source);
    vestige::mcap::StreamRecord record;
    while (reader.next(record))
      if (record.opcode == Opcode::kMessage) ++messages;
  } catch (const vestige::Error&) {
    // It does not begin as an MCAP file does, which recovering does not need.
  }
  return messages;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  Recovery recovery;
  std::vector<std::byte> mended;
  try {
    mended = recovered(bytes, recovery);
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
    return 0;
  }
  require(recovery.messages >= readable_messages(bytes) || recovery.lost_something(), "what is lost is admitted");
  const mcap::MemorySource source(mended);
  const TraceCheck check = check_trace(source, [](double) { return true; });
  require(check.container.has_footer && check.container.damaged_chunks == 0, "what is recovered is sound");
  if (recovery.messages == 0) return 0;
  Recovery again;
  static_cast<void>(recovered(mended, again));
  require(again.messages == recovery.messages, "recovering what was recovered loses nothing");
  return 0;
}
