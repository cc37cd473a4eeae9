#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// The content that `vestige inspect` shows of any MCAP file, a Vestige trace or not.
struct McapSummary {
  struct Channel {
    std::string topic;
    std::string encoding;  ///< encoding of the messages
    std::string schema;    ///< name of the schema; empty: none
    std::uint64_t messages = 0;
    double rate_hz = 0;  ///< (messages - 1) / duration; 0 if that is undefined
  };
  struct Attachment {
    std::string name;
    std::string media_type;
    std::uint64_t bytes = 0;
    std::string sha256;               ///< 64 hexadecimal digits
    std::optional<bool> is_recorded;  ///< whether this is the recorded SHA-256; nothing: none is recorded
  };

  std::string profile;
  std::string library;
  std::uint64_t file_bytes = 0;
  std::uint64_t messages = 0;
  std::vector<Channel> channels;  ///< by channel id
  std::uint64_t chunks = 0;
  std::vector<std::string> compression;  ///< of the chunks, each once: "none", "lz4", "zstd" or a foreign name
  std::uint64_t compressed_bytes = 0;    ///< total of all chunks
  std::uint64_t uncompressed_bytes = 0;
  std::vector<Attachment> attachments;
  bool is_trace = false;           ///< whether it has a channel /pose of Vestige
  std::size_t people = 1;          ///< of a Vestige trace; see `people_of`
  std::optional<Session> session;  ///< the metadata record `session`, if there is one
  std::string recovered;           ///< as `TraceReader::recovered`
  std::uint64_t start_ns = 0;      ///< first log_time
  std::uint64_t end_ns = 0;        ///< last log_time
  double duration_s = 0;
  std::uint64_t dropped = 0;                              ///< messages that a Vestige recorder noted as lost
  std::map<std::string, std::uint64_t> dropped_by_topic;  ///< topics beyond 1000 count together as "(other topics)"
  bool complete = false;                                  ///< the file has a footer and no damage
  std::vector<std::string> warnings;  ///< faults, one sentence each, with byte offset; after 1000, how many more
};

/// Reads the whole file and verifies every CRC. "-" is standard input. Throws `Error` if the file does not exist or is
/// not an MCAP file.
McapSummary summarise_mcap(const std::filesystem::path& path);

}  // namespace vestige
