#include "traces/repair/trace_check.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/scene/trace.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/recovered.hpp"
#include "traces/trace_file/session_check.hpp"
#include "traces/trace_file/trace_messages.hpp"
#include "traces/trace_file/trace_nodes.hpp"

namespace vestige {

namespace {

using mcap::CheckedRecord;
using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

constexpr std::string_view kRefused =
    "`vestige replay` refuses the file; `vestige recover` leaves out what does not fit";

/// Checks frames against each other, message by message, with the same rules by which `TraceReader` assembles them.
class FrameCheck {
 public:
  FrameCheck(TraceCheck& result, std::optional<std::size_t> node_count) : result_(result), node_count_(node_count) {}

  void set_node_count(std::size_t count) { node_count_ = count; }
  void expect_colliders() { colliders_channel_ = true; }
  void take(const CheckedRecord& record, Stream stream);
  void finish() { end_frame(); }

 private:
  /// Consecutive messages with the same number.
  struct Frame {
    CheckedRecord first;  ///< without its content
    std::uint32_t number = 0;
    bool has_pose = false;
    bool has_colliders = false;
    bool is_broken = false;  ///< one of its messages was bad, which was already reported
  };

  void end_frame();
  void take_pose(const CheckedRecord& record, const mcap::Message& message);
  void take_colliders(const CheckedRecord& record, const mcap::Message& message);
  void take_event(const CheckedRecord& record, const mcap::Message& message);
  void report(const CheckedRecord& record, std::string what, std::string_view consequence);
  void refuse(const CheckedRecord& record, std::string what);

  TraceCheck& result_;
  std::optional<std::size_t> node_count_;
  MessageDecoder decoder_;
  std::vector<ColliderSample> colliders_;
  std::optional<Frame> frame_;              ///< the frame being read
  std::optional<std::uint32_t> delivered_;  ///< number of the last frame that readers deliver
  std::optional<std::uint64_t> last_time_ns_;
  bool refused_ = false;            ///< readers stop at this frame
  bool colliders_channel_ = false;  ///< there is a channel /colliders
};

void FrameCheck::report(const CheckedRecord& record, std::string what, std::string_view consequence) {
  result_.problems.add({.offset = record.offset,
                        .bytes = record.bytes,
                        .offset_in_chunk = record.offset_in_chunk,
                        .what = std::move(what),
                        .consequence = std::string(consequence)});
}

void FrameCheck::refuse(const CheckedRecord& record, std::string what) {
  refused_ = frame_->is_broken = true;
  report(record, std::move(what), kRefused);
}

void FrameCheck::end_frame() {
  if (!frame_) return;
  const Frame frame = *std::exchange(frame_, {});
  if (!frame.has_pose) {
    if (frame.has_colliders && !frame.is_broken)
      report(frame.first, fmt::format("frame {} has no pose", frame.number), "it is left out");
    return;
  }
  if (!frame.has_colliders && !frame.is_broken && colliders_channel_)
    report(frame.first, fmt::format("frame {} has no message of /colliders", frame.number),
           "the frame has no colliders, and no collider moves from it to the next frame");
  const std::uint64_t expected = delivered_ ? std::uint64_t{*delivered_} + 1 : frame.number;
  if (frame.number > expected)
    report(frame.first,
           frame.number == expected + 1 ? fmt::format("frame {} is missing", expected)
                                        : fmt::format("frames {} to {} are missing", expected, frame.number - 1),
           fmt::format("no collider moves into frame {}, so it has no contacts", frame.number));
  delivered_ = frame.number;
  if (!refused_) ++result_.frames;
}

void FrameCheck::take(const CheckedRecord& record, Stream stream) {
  const mcap::Message message = mcap::decode_message(record.content);
  if (!frame_ || frame_->number != message.sequence) {
    end_frame();
    frame_ = {.first = record, .number = message.sequence};
    frame_->first.content = {};
  }
  const bool is_first_part = !frame_->has_pose && !frame_->has_colliders;
  if (stream != Stream::kEvents && is_first_part && delivered_ && message.sequence <= *delivered_)
    refuse(record, fmt::format("frame {} comes after frame {}", message.sequence, *delivered_));
  try {
    if (stream == Stream::kEvents) take_event(record, message);
    if (stream == Stream::kPose) take_pose(record, message);
    if (stream == Stream::kColliders) take_colliders(record, message);
  } catch (const Malformed& malformed) {
    frame_->is_broken = true;
    report(record, fmt::format("a message of frame {}: {}", message.sequence, malformed.what()), "it is left out");
  }
}

void FrameCheck::take_pose(const CheckedRecord& record, const mcap::Message& message) {
  if (frame_->has_pose) refuse(record, fmt::format("frame {} has two poses", frame_->number));
  const std::size_t nodes = decoder_.pose_node_count(message.data);
  if (node_count_ && nodes != *node_count_)
    refuse(record,
           fmt::format("frame {}: its pose has {} nodes, but the avatar has {}", frame_->number, nodes, *node_count_));
  if (message.log_time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    refuse(record, fmt::format("frame {}: its time is out of range", frame_->number));
  if (last_time_ns_ && message.log_time < *last_time_ns_)
    refuse(record, fmt::format("frame {}: its time, {} ns, is earlier than that of the frame before, {} ns",
                               frame_->number, message.log_time, *last_time_ns_));
  last_time_ns_ = message.log_time;
  frame_->has_pose = true;
}

void FrameCheck::take_colliders(const CheckedRecord& record, const mcap::Message& message) {
  if (frame_->has_colliders) refuse(record, fmt::format("frame {} has its colliders twice", frame_->number));
  decoder_.colliders(message.data, colliders_);
  frame_->has_colliders = true;
}

void FrameCheck::take_event(const CheckedRecord& record, const mcap::Message& message) {
  const TraceEvent event = decoder_.event(message.data);
  if (event.kind != trace_format::kDroppedKind) return;
  result_.dropped += event.count;
  report(record,
         fmt::format("{} of {} {} dropped while recording, near frame {}", counted(event.count, "message"),
                     dropped_topic(event), event.count == 1 ? "was" : "were", message.sequence),
         "they were never in the file");
}

/// The trace's statements about itself: session, attachments, nodes.
class Contents {
 public:
  Contents(TraceCheck& result, std::string file) : result_(result), file_(std::move(file)) {}

  void take(const mcap::Metadata& metadata, std::uint64_t offset) {
    if (metadata.name == trace_format::kRecoveredName)
      report(offset, "it " + describe_recovered(metadata.metadata), "the lost data is not in the file");
    if (metadata.name == trace_format::kReplacedName) claims_.replaced = metadata.metadata;
    if (metadata.name != trace_format::kSessionName) return;
    has_session_ = true;
    claims_.session = metadata.metadata;
    session_offset_ = offset;
  }
  void take(const mcap::Attachment& attachment) {
    if (attachment.name == trace_format::kAvatarName) avatar_nodes_ = glb_node_count(attachment.data);
    sha256_[attachment.name] = sha256_hex(attachment.data);
  }
  void finish(std::optional<std::size_t> pose_nodes, const StreamTable& streams);

 private:
  void report(std::uint64_t offset, std::string what, std::string consequence) {
    result_.problems.add({.offset = offset, .what = std::move(what), .consequence = std::move(consequence)});
  }

  TraceCheck& result_;
  std::string file_;
  bool has_session_ = false;
  AttachmentClaims claims_;
  std::uint64_t session_offset_ = 0;
  std::map<std::string, std::string> sha256_;
  std::optional<std::size_t> avatar_nodes_;
};

void Contents::finish(std::optional<std::size_t> pose_nodes, const StreamTable& streams) {
  claims_.pose = pose_metadata(streams);
  claims_.version_of_schemas = streams.version_of_schemas();
  const std::string avatar(trace_format::kAvatarName);
  if (!sha256_.contains(avatar) && recorded_sha256(claims_, avatar).empty())
    report(0, fmt::format("there is no undamaged attachment {}", avatar),
           fmt::format("`vestige replay` has no body to move, and refuses the file; {} puts one in",
                       replacing_command(file_, claims_, avatar)));
  if (avatar_nodes_ && pose_nodes && *avatar_nodes_ != *pose_nodes)
    report(0, fmt::format("its poses have {} nodes, but its avatar has {}", *pose_nodes, *avatar_nodes_),
           "`vestige replay` refuses the file");
  if (!has_session_) report(0, "there is no metadata record 'session'", "the file does not say how it was recorded");
  for (const auto& [name, sha256] : sha256_)
    result_.attachments.push_back({.name = name, .sha256 = sha256, .is_recorded = is_recorded(claims_, name, sha256)});
  for (SessionProblem& problem : check_session(file_, claims_, sha256_))
    report(session_offset_, std::move(problem.what), std::move(problem.consequence));
}

class Checker {
 public:
  explicit Checker(const mcap::ByteSource& source) : frames_(result_, {}), contents_(result_, source.name()) {
    // As in the reader, definitions that the summary repeats are known from the beginning.
    try {
      const mcap::SummaryResult summary = mcap::read_summary(source);
      if (!summary.summary) return;
      for (const mcap::Schema& schema : summary.summary->schemas) streams_.add(schema);
      for (const mcap::Channel& channel : summary.summary->channels) take(channel);
    } catch (const Error&) {
      // The container check reports faults at the beginning.
      return;
    }
  }

  void take(const CheckedRecord& record);
  TraceCheck finish();
  TraceCheck& result() { return result_; }

 private:
  void take(const mcap::Channel& channel);

  TraceCheck result_;
  StreamTable streams_;
  FrameCheck frames_;
  Contents contents_;
  std::optional<std::size_t> node_count_;
};

void Checker::take(const mcap::Channel& channel) {
  streams_.add(channel);
  const Stream stream = streams_.stream_of(channel.id);
  if (stream == Stream::kForeign) return;
  result_.is_trace = true;
  if (stream == Stream::kColliders) frames_.expect_colliders();
  if (stream != Stream::kPose || node_count_) return;
  if (const auto names = parse_node_names(channel)) {
    node_count_ = names->size();
    frames_.set_node_count(names->size());
  }
}

void Checker::take(const CheckedRecord& record) {
  switch (record.opcode) {
    case Opcode::kHeader:
      if (mcap::decode_header(record.content).profile == trace_format::kProfile) result_.is_trace = true;
      break;
    case Opcode::kSchema:
      streams_.add(mcap::decode_schema(record.content));
      break;
    case Opcode::kChannel:
      take(mcap::decode_channel(record.content));
      break;
    case Opcode::kAttachment:
      contents_.take(mcap::decode_attachment(record.content));
      break;
    case Opcode::kMetadata:
      contents_.take(mcap::decode_metadata(record.content), record.offset);
      break;
    case Opcode::kMessage: {
      const Stream stream = streams_.stream_of(mcap::decode_message(record.content).channel_id);
      if (stream != Stream::kForeign) frames_.take(record, stream);
      break;
    }
    default:
      break;
  }
}

TraceCheck Checker::finish() {
  frames_.finish();
  if (!result_.is_trace) return std::move(result_);
  if (!node_count_)
    result_.problems.add({.what = "no channel /pose says which nodes the poses have",
                          .consequence = "`vestige replay` refuses the file"});
  contents_.finish(node_count_, streams_);
  if (result_.frames == 0 && result_.problems.count() == 0)
    result_.problems.add({.what = "it holds no frame", .consequence = "there is nothing to replay"});
  return std::move(result_);
}

}  // namespace

TraceCheck check_trace(const mcap::ByteSource& source, const std::function<bool(double)>& progress) {
  Checker checker(source);
  checker.result().container = mcap::check_container(
      source, checker.result().problems, [&](const CheckedRecord& record) { checker.take(record); }, progress);
  TraceCheck result = checker.finish();
  result.problems.sort_by_offset();
  return result;
}

}  // namespace vestige
