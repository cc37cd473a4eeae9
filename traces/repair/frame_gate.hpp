#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "traces/mcap/check/chunk_salvage.hpp"
#include "traces/mcap/record.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {

/// Passes on the messages that form a trace which `TraceReader` reads to its end: whole frames that fit the avatar and
/// follow each other. Messages of foreign channels pass. A frame of several people is whole with the poses of all; in a
/// damaged trace it also passes with the poses of some, as `TraceReader` delivers it.
///
/// An unverified frame, which no CRC covers, passes only under three conditions. Its pose and colliders agree on frame
/// and time. A recorder could have written them. It lies between the verified frames around it, so the gate holds it
/// back until the next verified frame. Of the frames held back, the longest sequence passes that can have been recorded
/// at 1 MHz at most. Needs memory for one frame, or 16 MiB if many unverified frames follow each other.
class FrameGate {
 public:
  using Write = std::function<void(const mcap::Message&)>;

  /// Keeps a reference to `streams`, which says which channels are Vestige's own.
  FrameGate(const StreamTable& streams, Write write) : streams_(streams), write_(std::move(write)) {}

  /// Sets the number of nodes of a person's avatar. Without this call, any number passes.
  void set_node_count(std::size_t person, std::size_t count) { node_counts_[person] = count; }
  /// Takes the next message of the file; copies its data.
  void take(const mcap::Message& message, mcap::Trust trust);
  /// Call this after the last message.
  void finish();

  std::uint64_t left_out() const { return left_out_; }      ///< messages
  std::uint64_t unverified() const { return unverified_; }  ///< messages passed on although no CRC covers them

 private:
  struct Held {
    mcap::Message message;
    trace_format::Stream stream = trace_format::Stream::kForeign;
    std::size_t person = 0;  ///< whose pose
    std::vector<std::byte> data;
  };
  /// Consecutive messages of one frame, and the foreign messages between them.
  struct Group {
    std::uint32_t sequence = 0;
    std::uint64_t time_ns = 0;  ///< of the poses
    mcap::Trust trust = mcap::Trust::kVerified;
    bool has_frame = false;  ///< has a pose or colliders, not only events
    std::vector<Held> messages;
    std::size_t bytes = 0;
  };

  void end_group();
  /// Removes messages that cannot be read. Returns whether a good frame is left.
  bool clean(Group& group);
  bool is_readable(const Held& held);
  bool is_plausible(const Held& held);
  bool keeps_owners();
  bool has_nodes(std::size_t person, std::size_t nodes) const;
  std::vector<bool> longest_sequence(const Group* next) const;
  void release(const Group* next);
  void write(Group& group);
  void leave_out_frame(Group& group);

  const StreamTable& streams_;
  Write write_;
  std::map<std::size_t, std::size_t> node_counts_;  ///< by person
  std::map<std::uint32_t, std::uint16_t> owners_;   ///< of colliders, in a trace of the version that has owners
  MessageDecoder decoder_;
  std::vector<ColliderSample> colliders_;
  Pose pose_;
  Group group_;                ///< being assembled
  std::deque<Group> waiting_;  ///< unverified frames
  std::size_t waiting_bytes_ = 0;
  std::optional<std::uint32_t> last_sequence_;
  std::uint64_t last_time_ns_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t unverified_ = 0;
};

}  // namespace vestige
