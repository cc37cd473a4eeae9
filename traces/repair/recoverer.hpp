#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "traces/mcap/check/chunk_salvage.hpp"
#include "traces/mcap/crc32.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/repair/frame_gate.hpp"
#include "traces/repair/recover.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/mcap_output.hpp"
#include "traces/trace_file/trace_nodes.hpp"

namespace vestige {

/// The node names in the metadata of a file's channels /pose: of each topic, those of the first such channel. A channel
/// with other names belongs to none of the file's frames.
class PoseNodes {
 public:
  bool agrees(const mcap::Channel& channel) {
    const std::string topic = trace_format::channel_of(trace_format::Stream::kPose).topic;
    if (channel.topic != topic && !channel.topic.starts_with(topic + "/")) return true;
    auto names = parse_node_names(channel);
    const auto [known, is_first] = names_.try_emplace(channel.topic, names);
    return is_first || known->second == names;
  }

 private:
  std::map<std::string, std::optional<std::vector<std::string>>> names_;
};

/// Reads a damaged file record by record (recover.cpp), and writes or replaces its attachments
/// (recover_attachments.cpp).
class Recoverer {
 public:
  Recoverer(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, Definitions definitions,
            ReplacementPlan plan = {});

  Recovery run(const std::function<bool(double)>& progress);
  /// After `run`.
  AttachmentFacts facts() const;

 private:
  void take_damages();
  void take_damage(const mcap::Damage& damage);
  void take(const mcap::RecordPlace& place);
  void take_record(mcap::Opcode opcode, mcap::Bytes content, std::uint64_t offset);
  void take_chunk(mcap::Bytes content);
  void take_misnamed(mcap::Bytes content, std::uint64_t offset);
  void take_attachment(mcap::Bytes content);
  void take_metadata(mcap::Metadata metadata);
  void drop_facing(mcap::StringMap& session, std::size_t person);
  void mend_version(mcap::StringMap& session);
  void note_attachment(const mcap::Attachment& attachment, std::string_view name, bool is_whole);
  void replace(const std::string& name, const Replacement& replacement);
  void write_replaced();
  void take_data_end(const mcap::RecordPlace& place, mcap::Bytes content);
  void take_records(mcap::Bytes records);
  void take_remains(mcap::Bytes records);
  void take_inner(mcap::Opcode opcode, mcap::Bytes content, mcap::Trust trust);
  void write(const mcap::Message& message);
  void learn_node_counts();
  std::uint64_t bytes_of_rebuilt(const mcap::Damage& damage);
  void repaired(std::string what);
  void count_messages();
  void finish();

  const mcap::ByteSource& source_;
  ReplacementPlan plan_;
  AttachmentFacts facts_;
  std::set<std::string> replaced_;  ///< names in plan_ that are written
  mcap::RecordWalker walker_;
  PoseNodes pose_nodes_;
  McapOutput output_;
  FrameGate gate_;
  Recovery result_;
  mcap::RawBuffer content_;
  mcap::RawBuffer expanded_;
  std::uint64_t messages_found_ = 0;
  std::uint64_t unknown_messages_ = 0;
  std::uint32_t crc_ = mcap::crc32(std::as_bytes(std::span(mcap::kMagic)));
  std::uint64_t crc_end_ = mcap::kMagicBytes;  ///< the end of the bytes that crc_ covers
  bool data_ended_ = false;
};

}  // namespace vestige
