#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/mcap_output.hpp"

namespace vestige {

/// A channel that a copy has beside those of the trace, if it has a message. Ids are chosen by the copy.
struct AddedChannel {
  mcap::Channel channel;
  mcap::Schema schema;
};

/// Copies a trace frame by frame, so that messages on further channels can follow the messages of each frame. What is
/// copied keeps its sequence, times and data to the bit; the compression is that of the source. The source's messages
/// on topics of added channels are left out. Keeps the largest record and chunk in memory.
///
/// Throws `Error` if the source is not an MCAP file, cannot be read, or defines a channel or schema late or
/// differently, with an id that an added one has. Exceptions of the sink pass through.
class TraceCopy {
 public:
  /// Keeps a reference to `source`.
  TraceCopy(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, std::span<const AddedChannel> added);

  /// Copies all records before the first message of a later frame. Frame numbers must not decrease from call to call.
  void copy_through(std::uint64_t frame);
  /// Writes a message of an added channel, which is its place in the list.
  void write(std::size_t added, std::uint32_t sequence, std::uint64_t time_ns, mcap::Bytes data);
  /// Copies the rest, and ends the file.
  void finish();

  std::uint64_t bytes_written() const { return output_->bytes_written(); }
  /// The parts of the source that could not be read and are not in the copy.
  mcap::DamageList damages() const;

 private:
  void choose_ids(const Definitions& definitions);
  void take(const mcap::StreamRecord& record);
  void take_message(const mcap::StreamRecord& record);
  void take_definition(mcap::Schema schema);
  void take_definition(mcap::Channel channel);
  [[noreturn]] void refuse(std::string_view what, std::uint16_t id, std::string_view cause) const;

  const mcap::ByteSource& source_;
  mcap::StreamReader reader_;
  std::vector<AddedChannel> added_;         ///< with their ids
  std::set<std::uint16_t> shared_schemas_;  ///< ids of the added schemas that the source has, too
  std::set<std::uint16_t> replaced_;        ///< ids of the source's channels on topics of added ones
  std::set<std::uint16_t> undefined_;       ///< ids of channels that messages have and nothing defines
  mcap::DamageList damages_;                ///< beside those of the reader
  std::optional<McapOutput> output_;        ///< always there after construction
  std::optional<mcap::StreamRecord> head_;  ///< read, but not copied yet
};

}  // namespace vestige
