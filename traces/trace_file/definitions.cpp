#include "traces/trace_file/definitions.hpp"

#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/summary.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;

void take_summary(const mcap::ByteSource& source, Definitions& definitions) {
  try {
    mcap::SummaryResult result = mcap::read_summary(source);
    if (!result.summary || result.summary->footer.summary_crc == 0) return;
    for (mcap::Schema& schema : result.summary->schemas) definitions.schemas.try_emplace(schema.id, std::move(schema));
    for (mcap::Channel& channel : result.summary->channels)
      definitions.channels.try_emplace(channel.id, std::move(channel));
    definitions.statistics = std::move(result.summary->statistics);
  } catch (const Error&) {
    // A broken beginning does not matter here.
    return;
  }
}

/// Returns the compression that a Chunk's first fields name.
std::optional<mcap::Compression> compression_of(const mcap::ByteSource& source, const mcap::RecordPlace& place) {
  constexpr std::uint64_t kEnoughBytes = 64;
  mcap::RawBuffer buffer;
  const auto count = static_cast<std::size_t>(std::min(kEnoughBytes, place.content_bytes));
  source.read_at(place.content_offset(), buffer.reset(count));
  try {
    mcap::Cursor cursor(buffer.bytes());
    cursor.bytes(8 + 8 + 8 + 4);  // times, size, CRC
    const std::string_view name = cursor.string();
    for (const auto known : {mcap::Compression::kNone, mcap::Compression::kLz4, mcap::Compression::kZstd})
      if (name == mcap::name_of(known)) return known;
  } catch (const Malformed&) {
    return {};
  }
  return {};
}

}  // namespace

Definitions gather_definitions(const mcap::ByteSource& source) {
  Definitions definitions;
  take_summary(source, definitions);
  mcap::RecordWalker walker(source, mcap::MagicBytes::kMayBeBroken);
  mcap::RecordPlace place;
  mcap::RawBuffer buffer;
  while (walker.next(place)) {
    try {
      if (place.opcode == Opcode::kHeader && !definitions.header) {
        definitions.header = mcap::decode_header(walker.content(place, buffer));
      } else if (place.opcode == Opcode::kSchema) {
        mcap::Schema schema = mcap::decode_schema(walker.content(place, buffer));
        definitions.schemas.try_emplace(schema.id, std::move(schema));
      } else if (place.opcode == Opcode::kChannel) {
        mcap::Channel channel = mcap::decode_channel(walker.content(place, buffer));
        definitions.channels.try_emplace(channel.id, std::move(channel));
      } else if (place.opcode == Opcode::kChunk && !definitions.compression) {
        definitions.compression = compression_of(source, place);
      }
    } catch (const Malformed&) {
      continue;  // the file may hold another copy
    }
  }
  definitions.schemas.erase(0);
  return definitions;
}

StreamTable streams_of(const Definitions& definitions) {
  StreamTable streams;
  for (const auto& [id, schema] : definitions.schemas) streams.add(schema);
  for (const auto& [id, channel] : definitions.channels) streams.add(channel);
  return streams;
}

}  // namespace vestige
