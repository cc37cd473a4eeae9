#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/test_data.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige::test {

/// Every MCAP file of the test data, none of which is ours and all of which are sound.
inline std::vector<std::filesystem::path> foreign_mcaps() {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data("mcap")))
    if (entry.path().extension() == ".mcap") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// SHA-256 over everything in a file that a rewrite must keep: messages with their channel's topic, attachments,
/// metadata, in order.
inline std::string content_sha256(std::span<const std::byte> bytes) {
  const mcap::MemorySource source(bytes);
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  Sha256 sha;
  while (reader.next(record)) {
    const bool kept = record.opcode == mcap::Opcode::kMessage || record.opcode == mcap::Opcode::kAttachment ||
                      record.opcode == mcap::Opcode::kMetadata;
    if (!kept) continue;
    // What a writer of padded records adds behind the fields is not content.
    const auto natural = mcap::natural_content_bytes(record.opcode, record.content);
    sha.update(record.content.first(natural.value_or(record.content.size())));
  }
  return sha.hex();
}

/// A sink that keeps everything.
inline mcap::Writer::Sink into(std::vector<std::byte>& bytes) {
  return [&bytes](mcap::Bytes more) { bytes.insert(bytes.end(), more.begin(), more.end()); };
}

/// A file of one chunk that was not compressed, and nothing behind it. A CRC of 0 vouches for nothing.
inline mcap::ByteBuffer file_of_chunk(mcap::Bytes records, std::uint32_t uncompressed_crc) {
  mcap::ByteBuffer bytes;
  mcap::append_magic(bytes);
  append_record(bytes, mcap::Header{});
  append_record(bytes, mcap::Chunk{.uncompressed_size = records.size(),
                                   .uncompressed_crc = uncompressed_crc,
                                   .compression = "",
                                   .records = records});
  return bytes;
}

inline bool go_on(double /*share*/) {
  return true;
}

}  // namespace vestige::test
