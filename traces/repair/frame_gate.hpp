#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "traces/mcap/check/chunk_salvage.hpp"
#include "traces/mcap/record.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {

/// Lets through what makes a trace that `TraceReader` reads to its end: whole frames that fit the avatar and come one
/// after the other. Messages of other channels pass.
///
/// A frame that no CRC vouches for must have a pose and colliders that agree on frame and time and that a recorder
/// could have written, and must lie between the frames around it that are vouched for: until the next of those it is
/// held back. Of those held back, the longest sequence passes that can have been recorded, at 1 MHz at most. Needs one
/// frame of memory, or 16 MiB where many unverified ones follow each other.
class FrameGate {
 public:
  using Write = std::function<void(const mcap::Message&)>;

  /// `streams` must stay; it says which channels are ours.
  FrameGate(const StreamTable& streams, Write write) : streams_(streams), write_(std::move(write)) {}

  /// The avatar's; without it any number passes.
  void set_node_count(std::size_t count) { node_count_ = count; }
  /// The next message of the file; its data is copied.
  void take(const mcap::Message& message, mcap::Trust trust);
  /// No more messages.
  void finish();

  std::uint64_t left_out() const { return left_out_; }      ///< messages
  std::uint64_t unverified() const { return unverified_; }  ///< messages that were let through though no CRC holds

 private:
  struct Held {
    mcap::Message message;
    trace_format::Stream stream = trace_format::Stream::kForeign;
    std::vector<std::byte> data;
  };
  /// Neighbouring messages of one frame, and those of other channels between them.
  struct Group {
    std::uint32_t sequence = 0;
    std::uint64_t time_ns = 0;  ///< of the pose
    mcap::Trust trust = mcap::Trust::kVerified;
    bool has_frame = false;  ///< a pose or colliders, not events only
    std::vector<Held> messages;
    std::size_t bytes = 0;
  };

  void end_group();
  /// Leaves out what cannot be read; returns whether a good frame is left.
  bool clean(Group& group);
  bool is_readable(const Held& held);
  bool is_plausible(const Held& held);
  std::vector<bool> longest_sequence(const Group* next) const;
  void release(const Group* next);
  void write(Group& group);
  void leave_out_frame(Group& group);

  const StreamTable& streams_;
  Write write_;
  std::optional<std::size_t> node_count_;
  MessageDecoder decoder_;
  std::vector<ColliderSample> colliders_;
  Pose pose_;
  Group group_;                ///< being put together
  std::deque<Group> waiting_;  ///< unverified frames
  std::size_t waiting_bytes_ = 0;
  std::optional<std::uint32_t> last_sequence_;
  std::uint64_t last_time_ns_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t unverified_ = 0;
};

}  // namespace vestige
