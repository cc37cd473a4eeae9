#include "traces/repair/trace_check.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/scene/people.hpp"
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
  explicit FrameCheck(TraceCheck& result) : result_(result) {}

  /// Tells the number of nodes in the poses of a person.
  void set_node_count(std::size_t person, std::size_t count) { node_counts_[person] = count; }
  void expect_pose(std::size_t person) { people_.insert(person); }
  void expect_colliders() { colliders_channel_ = true; }
  void expect_owners() { has_owners_ = true; }
  void take(const CheckedRecord& record, trace_format::StreamId stream);
  void finish() { end_frame(); }
  /// Reports a collider whose owner is not among the people of the trace.
  void check_owners(std::size_t people);

 private:
  /// Consecutive messages with the same number.
  struct Frame {
    CheckedRecord first;  ///< without its content
    std::uint32_t number = 0;
    std::set<std::size_t> poses;  ///< the people whose pose it has
    bool has_colliders = false;
    bool is_broken = false;  ///< one of its messages was bad, which was already reported
  };

  void end_frame();
  void report_missing_poses(const Frame& frame);
  void take_pose(const CheckedRecord& record, const mcap::Message& message, std::size_t person);
  void take_colliders(const CheckedRecord& record, const mcap::Message& message);
  void take_event(const CheckedRecord& record, const mcap::Message& message);
  void report(const CheckedRecord& record, std::string what, std::string_view consequence);
  void refuse(const CheckedRecord& record, std::string what);

  TraceCheck& result_;
  std::map<std::size_t, std::size_t> node_counts_;  ///< by person
  std::set<std::size_t> people_;                    ///< those who have a channel /pose
  bool has_owners_ = false;                         ///< whether the schema of /colliders has owners
  std::map<std::uint32_t, std::uint16_t> owners_;   ///< of colliders, if the schema has them
  /// A collider with the largest owner.
  struct Owned {
    CheckedRecord record;  ///< without its content
    std::uint32_t frame = 0;
    ColliderSample collider;
  };
  std::optional<Owned> largest_owner_;
  MessageDecoder decoder_;
  std::vector<ColliderSample> colliders_;
  std::optional<Frame> frame_;                 ///< the frame being read
  std::optional<std::uint32_t> delivered_;     ///< number of the last frame that readers deliver
  std::optional<std::uint64_t> last_time_ns_;  ///< of the last pose
  bool refused_ = false;                       ///< readers stop at this frame
  bool colliders_channel_ = false;             ///< there is a channel /colliders
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
  if (frame.poses.empty()) {
    if (frame.has_colliders && !frame.is_broken)
      report(frame.first, fmt::format("frame {} has no pose", frame.number), "it is left out");
    return;
  }
  if (!frame.has_colliders && !frame.is_broken && colliders_channel_)
    report(frame.first, fmt::format("frame {} has no message of /colliders", frame.number),
           "the frame has no colliders, and no collider moves from it to the next frame");
  if (!frame.is_broken) report_missing_poses(frame);
  const std::uint64_t expected = delivered_ ? std::uint64_t{*delivered_} + 1 : frame.number;
  if (frame.number > expected)
    report(frame.first,
           frame.number == expected + 1 ? fmt::format("frame {} is missing", expected)
                                        : fmt::format("frames {} to {} are missing", expected, frame.number - 1),
           fmt::format("no collider moves into frame {}, so it has no contacts", frame.number));
  delivered_ = frame.number;
  if (!refused_) ++result_.frames;
}

void FrameCheck::report_missing_poses(const Frame& frame) {
  for (const std::size_t person : people_)
    if (!frame.poses.contains(person))
      report(frame.first, fmt::format("frame {} has no pose of person {}", frame.number, person + 1),
             "nothing touches this person in the frame, and nothing moves from it to the next frame there");
}

void FrameCheck::take(const CheckedRecord& record, trace_format::StreamId id) {
  const Stream stream = id.stream;
  const mcap::Message message = mcap::decode_message(record.content);
  if (!frame_ || frame_->number != message.sequence) {
    end_frame();
    frame_ = {.first = record, .number = message.sequence, .poses = {}};
    frame_->first.content = {};
  }
  const bool is_first_part = frame_->poses.empty() && !frame_->has_colliders;
  if (stream != Stream::kEvents && is_first_part && delivered_ && message.sequence <= *delivered_)
    refuse(record, fmt::format("frame {} comes after frame {}", message.sequence, *delivered_));
  try {
    if (stream == Stream::kEvents) take_event(record, message);
    if (stream == Stream::kPose) take_pose(record, message, id.person);
    if (stream == Stream::kColliders) take_colliders(record, message);
  } catch (const Malformed& malformed) {
    frame_->is_broken = true;
    report(record, fmt::format("a message of frame {}: {}", message.sequence, malformed.what()), "it is left out");
  }
}

void FrameCheck::take_pose(const CheckedRecord& record, const mcap::Message& message, std::size_t person) {
  const std::string whose = people_.size() > 1 ? fmt::format(" of person {}", person + 1) : "";
  if (frame_->poses.contains(person)) refuse(record, fmt::format("frame {} has two poses{}", frame_->number, whose));
  const std::size_t nodes = decoder_.pose_node_count(message.data);
  const auto expected = node_counts_.find(person);
  if (expected != node_counts_.end() && nodes != expected->second)
    refuse(record, fmt::format("frame {}: its pose{} has {} nodes, but the avatar has {}", frame_->number, whose, nodes,
                               expected->second));
  if (message.log_time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    refuse(record, fmt::format("frame {}: its time is out of range", frame_->number));
  if (!frame_->poses.empty()) {
    if (message.log_time != *last_time_ns_ && !frame_->poses.contains(person))
      refuse(record, fmt::format("frame {}: its poses are of different times, {} ns and {} ns", frame_->number,
                                 *last_time_ns_, message.log_time));
  } else if (last_time_ns_ && message.log_time < *last_time_ns_)
    refuse(record, fmt::format("frame {}: its time, {} ns, is earlier than that of the frame before, {} ns",
                               frame_->number, message.log_time, *last_time_ns_));
  last_time_ns_ = message.log_time;
  frame_->poses.insert(person);
}

void FrameCheck::take_colliders(const CheckedRecord& record, const mcap::Message& message) {
  if (frame_->has_colliders) refuse(record, fmt::format("frame {} has its colliders twice", frame_->number));
  decoder_.colliders(message.data, colliders_);
  frame_->has_colliders = true;
  if (!has_owners_) return;
  for (const ColliderSample& collider : colliders_) {
    if (!largest_owner_ || collider.owner > largest_owner_->collider.owner) {
      largest_owner_ = {.record = record, .frame = frame_->number, .collider = collider};
      largest_owner_->record.content = {};
    }
    if (owners_.size() == kMostColliders && !owners_.contains(collider.id)) continue;
    const auto [known, is_new] = owners_.try_emplace(collider.id, collider.owner);
    if (std::exchange(known->second, collider.owner) != collider.owner)
      refuse(record, fmt::format("frame {}: collider {} changes its owner to {}", frame_->number, collider.id,
                                 in_words(collider.owner)));
  }
}

void FrameCheck::check_owners(std::size_t people) {
  if (!largest_owner_) return;
  if (const auto fault = owner_fault({&largest_owner_->collider, 1}, people))
    report(largest_owner_->record, fmt::format("frame {}: {}", largest_owner_->frame, *fault),
           "the frame is read without colliders");
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
    const auto id = trace_format::attachment_id(attachment.name);
    if (id && id->kind == trace_format::AttachmentKind::kAvatar)
      if (const auto nodes = glb_node_count(attachment.data)) avatar_nodes_[id->person] = *nodes;
    sha256_[attachment.name] = sha256_hex(attachment.data);
  }
  void finish(const std::map<std::size_t, std::size_t>& pose_nodes, const StreamTable& streams);

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
  std::map<std::size_t, std::size_t> avatar_nodes_;  ///< by person
};

void Contents::finish(const std::map<std::size_t, std::size_t>& pose_nodes, const StreamTable& streams) {
  claims_.pose = pose_metadata(streams);
  claims_.version_of_schemas = streams.version_of_schemas();
  result_.people = people_of(claims_, streams, sha256_);
  for (std::size_t person = 0; person < result_.people; ++person) {
    const std::string avatar = trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, person);
    if (!sha256_.contains(avatar) && recorded_sha256(claims_, avatar).empty())
      report(0, fmt::format("there is no undamaged attachment {}", avatar),
             fmt::format("`vestige replay` has no body to move, and refuses the file; {} puts one in",
                         replacing_command(file_, claims_, avatar)));
    const std::string topic = trace_format::numbered("/pose", person);
    if (result_.people > 1 && streams.find(Stream::kPose, person) == nullptr)
      report(0, fmt::format("there is no channel {}", topic),
             fmt::format("person {} has no pose in any frame", person + 1));
    const auto nodes = avatar_nodes_.find(person);
    const auto posed = pose_nodes.find(person);
    if (nodes != avatar_nodes_.end() && posed != pose_nodes.end() && nodes->second != posed->second)
      report(0,
             person == 0 ? fmt::format("its poses have {} nodes, but its avatar has {}", posed->second, nodes->second)
                         : fmt::format("its poses {} have {} nodes, but its {} has {}", topic, posed->second, avatar,
                                       nodes->second),
             "`vestige replay` refuses the file");
  }
  if (!has_session_) report(0, "there is no metadata record 'session'", "the file does not say how it was recorded");
  for (const auto& [name, sha256] : sha256_)
    result_.attachments.push_back({.name = name, .sha256 = sha256, .is_recorded = is_recorded(claims_, name, sha256)});
  for (SessionProblem& problem : check_session(file_, claims_, sha256_))
    report(session_offset_, std::move(problem.what), std::move(problem.consequence));
}

class Checker {
 public:
  explicit Checker(const mcap::ByteSource& source) : frames_(result_), contents_(result_, source.name()) {
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
  std::map<std::size_t, std::size_t> node_counts_;  ///< of the poses, by person
};

void Checker::take(const mcap::Channel& channel) {
  streams_.add(channel);
  const Stream stream = streams_.stream_of(channel.id);
  const std::size_t person = streams_.person_of(channel.id);
  if (stream == Stream::kForeign) return;
  result_.is_trace = true;
  if (stream == Stream::kColliders) frames_.expect_colliders();
  if (streams_.version_of_schemas() == trace_format::kPeopleVersion) frames_.expect_owners();
  if (stream != Stream::kPose || node_counts_.contains(person)) return;
  frames_.expect_pose(person);
  if (const auto names = parse_node_names(channel)) {
    node_counts_[person] = names->size();
    frames_.set_node_count(person, names->size());
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
      const std::uint16_t channel = mcap::decode_message(record.content).channel_id;
      const trace_format::StreamId stream = {streams_.stream_of(channel), streams_.person_of(channel)};
      if (stream.stream != Stream::kForeign) frames_.take(record, stream);
      break;
    }
    default:
      break;
  }
}

TraceCheck Checker::finish() {
  frames_.finish();
  if (!result_.is_trace) return std::move(result_);
  const auto channels = streams_.pose_channels();
  if (node_counts_.empty())
    result_.problems.add({.what = "no channel /pose says which nodes the poses have",
                          .consequence = "`vestige replay` refuses the file"});
  else
    for (const auto& [person, channel] : channels)
      if (!node_counts_.contains(person))
        result_.problems.add({.what = fmt::format("channel {} does not say which nodes the poses have", channel->topic),
                              .consequence = "`vestige replay` refuses the file"});
  contents_.finish(node_counts_, streams_);
  frames_.check_owners(result_.people);
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
