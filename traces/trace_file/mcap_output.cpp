#include "traces/trace_file/mcap_output.hpp"

#include <fmt/format.h>

#include <utility>
#include <version.hpp>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kLargestChunkBytes = std::size_t{16} << 20;
constexpr std::size_t kFullChunkBytes = std::size_t{1} << 20;
constexpr std::size_t kMostSchemaBytes = std::size_t{256} << 20;  ///< schemas stay in memory, for the summary

}  // namespace

McapOutput::McapOutput(mcap::Writer::Sink sink, const std::string& profile, mcap::Compression compression,
                       Definitions definitions)
    : writer_(std::move(sink), {.profile = profile, .library = fmt::format("vestige {}", kVersion)},
              {.compression = compression, .definitions = mcap::DefinitionPlace::kBeforeChunks}),
      definitions_(std::move(definitions)) {
  for (const auto& [id, schema] : definitions_.schemas) learn(schema);
  for (const auto& [id, channel] : definitions_.channels) streams_.add(channel);
}

void McapOutput::write_definitions() {
  for (const auto& [id, schema] : definitions_.schemas) write_schema(id);
  for (const auto& [id, channel] : definitions_.channels) define(id);
}

void McapOutput::add(mcap::Schema schema) {
  if (schema.id == 0) return;
  // A channel that was written without its schema stays so. Adding the schema later would change the meaning of the
  // messages already written.
  if (schemas_lacking_.contains(schema.id)) return;
  const auto [known, is_new] = definitions_.schemas.try_emplace(schema.id, std::move(schema));
  if (is_new) learn(known->second);
}

void McapOutput::add(mcap::Channel channel) {
  const auto [known, is_new] = definitions_.channels.try_emplace(channel.id, std::move(channel));
  if (!is_new) return;
  streams_.add(known->second);
  define(known->first);
}

void McapOutput::learn(const mcap::Schema& schema) {
  schema_bytes_ += schema.data.size();
  if (schema_bytes_ > kMostSchemaBytes)
    throw Error("schemas", fmt::format("take more than {} bytes", kMostSchemaBytes), "use a file with fewer schemas");
  streams_.add(schema);
}

void McapOutput::write_schema(std::uint16_t id) {
  const auto schema = definitions_.schemas.find(id);
  if (schema == definitions_.schemas.end())
    schemas_lacking_.insert(id);
  else if (schemas_written_.insert(id).second)
    writer_.write(schema->second);
}

bool McapOutput::define(std::uint16_t channel_id) {
  const auto channel = definitions_.channels.find(channel_id);
  if (channel == definitions_.channels.end()) return false;
  if (!channels_written_.insert(channel_id).second) return true;
  write_schema(channel->second.schema_id);
  writer_.write(channel->second);
  return true;
}

bool McapOutput::write(const mcap::Message& message) {
  if (!define(message.channel_id)) return false;
  if (chunk_ended_ || writer_.open_chunk_bytes() >= kLargestChunkBytes) writer_.close_chunk();
  chunk_ended_ = false;
  writer_.write(message);
  return true;
}

void McapOutput::end_full_chunk() {
  if (writer_.open_chunk_bytes() >= kFullChunkBytes) end_chunk();
}

mcap::Damage undefined_channel(std::uint64_t offset, std::uint16_t channel_id) {
  return {
      offset, 0,
      fmt::format("a Message of channel {}, which is not defined; from here on, messages of this channel are left out",
                  channel_id)};
}

}  // namespace vestige
