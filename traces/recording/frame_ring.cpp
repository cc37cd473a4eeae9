#include "traces/recording/frame_ring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "traces/base/nanoseconds.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

using trace_format::Stream;

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
/// LZ4 compresses and expands more than 600 MB/s, so a ring hardly costs more than no recording.
constexpr mcap::Compression kCompression = mcap::Compression::kLz4;

/// Returns the channel id of a stream's messages in blocks. The trace's own channels have the numbers of their streams.
std::uint16_t id_of(Stream stream) {
  return trace_format::kStreams.at(static_cast<std::size_t>(stream)).id;
}

void append(mcap::ByteBuffer& out, Stream stream, std::uint64_t index, std::int64_t time_ns, mcap::Bytes data) {
  mcap::append_record(out, mcap::Message{.channel_id = id_of(stream),
                                         .sequence = static_cast<std::uint32_t>(index),
                                         .log_time = static_cast<std::uint64_t>(time_ns),
                                         .publish_time = index,  // all 64 bits: a frame's number may exceed 32 bits
                                         .data = data});
}

using Kind = RecordingNote::Kind;
constexpr std::array<std::pair<Kind, std::string_view>, 3> kKinds = {
    {{Kind::kDropped, trace_format::kDroppedKind},
     {Kind::kSuperseded, trace_format::kSupersededKind},
     {Kind::kMarker, trace_format::kMarkerKind}}};

std::string_view text_of(Kind kind) {
  return std::ranges::find(kKinds, kind, &std::pair<Kind, std::string_view>::first)->second;
}

Kind kind_of(std::string_view text) {
  return std::ranges::find(kKinds, text, &std::pair<Kind, std::string_view>::second)->first;
}

}  // namespace

void FrameRing::push(const RecordingNote& note) {
  append(open_, Stream::kEvents, 0, last_ns_,
         encoder_.event({.time_ns = last_ns_, .kind = text_of(note.kind), .count = note.count, .text = note.text}));
}

void FrameRing::push(const TraceFrame& frame) {
  last_ns_ = frame.time_ns;
  for (const std::uint32_t collider : frame.teleported)
    append(
        open_, Stream::kEvents, frame.index, last_ns_,
        encoder_.event({.time_ns = last_ns_, .kind = trace_format::kTeleportKind, .collider = collider, .text = {}}));
  for (const Pose& pose : frame.poses)
    append(open_, Stream::kPose, frame.index, last_ns_, encoder_.pose(last_ns_, pose));
  append(open_, Stream::kColliders, frame.index, last_ns_, encoder_.colliders(last_ns_, frame.colliders));
  if (open_.size() >= kBlockBytes) close_block();
  forget_old();
}

void FrameRing::close_block() {
  if (open_.empty()) return;
  auto block = std::make_shared<Contents::Block>();
  mcap::compress(kCompression, open_, block->bytes);
  block->bytes.shrink_to_fit();
  block->expanded_bytes = open_.size();
  block->last_ns = last_ns_;
  bytes_ += block->bytes.size();
  contents_.blocks_.push_back(std::move(block));
  open_.clear();
}

std::int64_t FrameRing::first_kept_ns() const {
  const double kept_ns = limits_.seconds * kNanosecondsPerSecond;
  return static_cast<double>(last_ns_) <= kept_ns ? 0 : last_ns_ - std::llround(kept_ns);
}

void FrameRing::forget_old() {
  const std::int64_t first_ns = first_kept_ns();
  auto& blocks = contents_.blocks_;
  while (blocks.size() > 1 && (blocks.front()->last_ns < first_ns || bytes() > limits_.bytes)) {
    is_cut_by_size_ = is_cut_by_size_ || blocks.front()->last_ns >= first_ns;
    bytes_ -= blocks.front()->bytes.size();
    blocks.pop_front();
  }
}

FrameRing::Contents FrameRing::contents() {
  close_block();
  forget_old();
  contents_.first_ns_ = first_kept_ns();
  return contents_;
}

void FrameRing::Contents::for_each(const TakeNote& take_note, const TakeFrame& take_frame) const {
  MessageDecoder decoder;
  mcap::RawBuffer expanded;
  TraceFrame frame;
  std::size_t person = 0;            ///< whose pose comes next in the frame
  std::vector<RecordingNote> notes;  ///< notes before the next frame
  bool begun = first_ns_ == 0;       ///< nothing has left the ring, or a frame was delivered
  const auto give_notes = [&] {
    for (const RecordingNote& note : notes)
      // Messages lost before the ring's first frame are not missing from the ring.
      if (begun || note.kind == RecordingNote::Kind::kMarker) take_note(note);
  };
  for (const auto& block : blocks_) {
    mcap::decompress(mcap::name_of(kCompression), block->bytes, block->expanded_bytes, expanded);
    mcap::Cursor cursor(expanded.bytes());
    while (cursor.remaining() > 0) {
      const mcap::Message message = mcap::decode_message(mcap::next_record(cursor).content);
      const auto time_ns = static_cast<std::int64_t>(message.log_time);
      if (message.channel_id == id_of(Stream::kEvents)) {
        const TraceEvent event = decoder.event(message.data);
        if (event.kind == trace_format::kTeleportKind) {
          frame.teleported.push_back(event.collider);
        } else {
          notes.push_back({.kind = kind_of(event.kind), .count = event.count, .text = std::string(event.text)});
        }
      } else if (message.channel_id == id_of(Stream::kPose)) {
        if (person == frame.poses.size()) frame.poses.emplace_back();
        decoder.pose(message.data, frame.poses[person++]);
      } else {
        decoder.colliders(message.data, frame.colliders);
        frame.index = message.publish_time;
        frame.time_ns = time_ns;
        if (time_ns >= first_ns_) {
          give_notes();
          if (!take_frame(frame)) return;
          begun = true;
        }
        notes.clear();
        frame.teleported.clear();
        person = 0;
      }
    }
  }
  give_notes();
}

}  // namespace vestige
