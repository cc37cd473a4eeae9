#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// What `vestige inspect` shows of any MCAP file, a trace of ours or not.
struct McapSummary {
  struct Channel {
    std::string topic;
    std::string encoding;  ///< of the messages
    std::string schema;    ///< its name, empty: none
    std::uint64_t messages = 0;
    double rate_hz = 0;  ///< (messages - 1) / duration; 0 where that says nothing
  };
  struct Attachment {
    std::string name;
    std::string media_type;
    std::uint64_t bytes = 0;
    std::string sha256;  ///< 64 hexadecimal digits
  };

  std::string profile;
  std::string library;
  std::uint64_t file_bytes = 0;
  std::uint64_t messages = 0;
  std::vector<Channel> channels;  ///< by channel id
  std::uint64_t chunks = 0;
  std::vector<std::string> compression;  ///< of the chunks, each once: "none", "lz4", "zstd", or a foreign name
  std::uint64_t compressed_bytes = 0;    ///< of all chunks together
  std::uint64_t uncompressed_bytes = 0;
  std::vector<Attachment> attachments;
  std::optional<Session> session;  ///< the metadata record `session`, where there is one
  std::string recovered;           ///< as `TraceReader::recovered`
  std::uint64_t start_ns = 0;      ///< first log_time
  std::uint64_t end_ns = 0;        ///< last log_time
  double duration_s = 0;
  std::uint64_t dropped = 0;                              ///< messages that a recorder of ours noted as lost
  std::map<std::string, std::uint64_t> dropped_by_topic;  ///< after 1000 the rest together, as "(other topics)"
  bool complete = false;                                  ///< it has a footer, and nothing is damaged
  std::vector<std::string> warnings;  ///< what is wrong, one sentence each, with byte offset; after 1000 how many more
};

/// Reads all of the file and verifies every CRC. Throws `Error`: no such file, no MCAP file. "-" is standard input.
McapSummary summarise_mcap(const std::filesystem::path& path);

}  // namespace vestige
