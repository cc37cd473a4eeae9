#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The content of a message on /events (schemas/event.fbs).
struct TraceEvent {
  std::int64_t time_ns = 0;
  std::string_view kind;
  std::uint32_t collider = 0;
  std::uint64_t count = 0;
  std::string_view text;
};

/// Returns the topic that an event of kind `dropped` names. A longer text than 200 bytes is cut, because a foreign file
/// may hold any text there.
std::string dropped_topic(const TraceEvent& event);

/// Encodes the messages of a trace. The result of a call is valid until the next call.
class MessageEncoder {
 public:
  MessageEncoder();
  ~MessageEncoder();
  MessageEncoder(const MessageEncoder&) = delete;
  MessageEncoder& operator=(const MessageEncoder&) = delete;

  mcap::Bytes pose(std::int64_t time_ns, const Pose& pose);
  mcap::Bytes colliders(std::int64_t time_ns, const std::vector<ColliderSample>& colliders);
  mcap::Bytes event(const TraceEvent& event);

 private:
  struct Builder;
  std::unique_ptr<Builder> builder_;
};

/// Decodes the messages of a trace. They may come from anyone, so each is verified before it is read. Throws
/// `mcap::Malformed`.
class MessageDecoder {
 public:
  /// Decodes a pose and returns its number of nodes.
  std::size_t pose(mcap::Bytes message, Pose& pose);
  /// Returns the number of nodes without decoding them.
  std::size_t pose_node_count(mcap::Bytes message);
  std::int64_t pose_time_ns(mcap::Bytes message);
  std::int64_t colliders_time_ns(mcap::Bytes message);
  /// Throws `mcap::Malformed` if an id occurs twice or a radius is impossible (`radius_fault`).
  void colliders(mcap::Bytes message, std::vector<ColliderSample>& colliders);
  /// Decodes an event, whose text is valid until the next call.
  TraceEvent event(mcap::Bytes message);

 private:
  template <typename Table>
  const Table& verified(mcap::Bytes message);

  std::vector<std::uint64_t> aligned_;  ///< aligned copy: a message may begin anywhere, FlatBuffers need alignment
  std::vector<std::uint32_t> ids_;
};

}  // namespace vestige
