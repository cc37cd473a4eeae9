#include "traces/repair/rewrite.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/mcap_output.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;

class Rewriter {
 public:
  Rewriter(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, const mcap::TimeRange& range,
           mcap::Compression compression, Definitions definitions)
      : source_(source),
        range_(range),
        reader_(source),
        output_(sink, definitions.header ? definitions.header->profile : std::string(), compression, definitions) {}

  Rewritten run(const std::function<bool(double)>& progress);

 private:
  void take(const mcap::StreamRecord& record);
  void take_message(const mcap::StreamRecord& record);
  void take_attachment(const mcap::StreamRecord& record);
  void require_messages() const;

  const mcap::ByteSource& source_;
  mcap::TimeRange range_;
  mcap::StreamReader reader_;
  McapOutput output_;
  Rewritten result_;
  std::set<std::uint16_t> undefined_;                                   ///< channels
  std::uint64_t first_ns_ = std::numeric_limits<std::uint64_t>::max();  ///< of all messages of the source
  std::uint64_t last_ns_ = 0;
  std::uint64_t chunk_offset_ = 0;
};

Rewritten Rewriter::run(const std::function<bool(double)>& progress) {
  mcap::StreamRecord record;
  while (reader_.next(record)) {
    try {
      take(record);
    } catch (const Malformed&) {
      continue;  // the reader notes records whose fields do not fit
    }
    if (!progress(static_cast<double>(record.offset) / static_cast<double>(source_.size())))
      throw Error(source_.name(), "the work was stopped; nothing was written", "");
  }
  require_messages();
  output_.write_definitions();
  output_.finish();
  const mcap::Statistics& statistics = output_.statistics();
  result_.messages = statistics.message_count;
  result_.start_ns = statistics.message_start_time;
  result_.end_ns = statistics.message_end_time;
  result_.bytes = output_.bytes_written();
  result_.damages.add(reader_.damages());
  return std::move(result_);
}

void Rewriter::take(const mcap::StreamRecord& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      output_.add(mcap::decode_schema(record.content));
      break;
    case Opcode::kChannel:
      output_.add(mcap::decode_channel(record.content));
      break;
    case Opcode::kMessage:
      take_message(record);
      break;
    case Opcode::kAttachment:
      take_attachment(record);
      break;
    case Opcode::kMetadata:
      output_.write(mcap::decode_metadata(record.content));
      break;
    default:
      break;
  }
}

void Rewriter::take_message(const mcap::StreamRecord& record) {
  if (!record.in_chunk) {
    output_.end_full_chunk();
  } else if (record.offset != chunk_offset_) {
    output_.end_chunk();
    chunk_offset_ = record.offset;
  }
  const mcap::Message message = mcap::decode_message(record.content);
  first_ns_ = std::min(first_ns_, message.log_time);
  last_ns_ = std::max(last_ns_, message.log_time);
  if (!range_.contains(message.log_time)) {
    ++result_.left_out;
  } else if (!output_.write(message) && undefined_.insert(message.channel_id).second) {
    result_.damages.add(undefined_channel(record.offset, message.channel_id));
  }
}

void Rewriter::take_attachment(const mcap::StreamRecord& record) {
  const mcap::Attachment attachment = mcap::decode_attachment(record.content);
  // The reader notes a damaged attachment. A new CRC must not make it look undamaged.
  if (mcap::attachment_crc_holds(record.content, attachment)) output_.write(attachment);
}

void Rewriter::require_messages() const {
  const mcap::Statistics& written = output_.statistics();
  const bool is_empty = written.message_count + written.attachment_count + written.metadata_count == 0;
  if (is_empty && result_.left_out == 0 && !reader_.damages().empty())
    throw Error(source_.name(), "nothing in it can be read", "check that it is the right file");
  if (result_.left_out == 0 || output_.statistics().message_count > 0) return;
  throw Error(source_.name(),
              fmt::format("no message is in the requested time range; its messages are from {} to {} s",
                          static_cast<double>(first_ns_) / kNanosecondsPerSecond,
                          static_cast<double>(last_ns_) / kNanosecondsPerSecond),
              "choose --from and --to in that range");
}

}  // namespace

Rewritten rewrite_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, const RewriteOptions& options,
                       const std::function<bool(double)>& progress) {
  mcap::require_mcap(source);
  const Definitions definitions = gather_definitions(source);
  const mcap::Compression compression =
      options.compression.value_or(definitions.compression.value_or(mcap::Compression::kNone));
  return Rewriter(source, sink, options.range, compression, definitions).run(progress);
}

}  // namespace vestige
