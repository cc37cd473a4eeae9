#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What a message on /events says (schemas/event.fbs).
struct TraceEvent {
  std::int64_t time_ns = 0;
  std::string_view kind;
  std::uint32_t collider = 0;
  std::uint64_t count = 0;
  std::string_view text;
};

/// The topic that an event of kind `dropped` names. Files of others may name anything there: 200 bytes of it at most.
std::string dropped_topic(const TraceEvent& event);

/// Makes the messages of a trace. What each call returns is valid until the next.
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

/// Reads the messages of a trace, which may come from anyone: each is verified before it is looked at. Throws
/// `mcap::Malformed`.
class MessageDecoder {
 public:
  /// Returns the number of nodes.
  std::size_t pose(mcap::Bytes message, Pose& pose);
  /// As above, without decoding the nodes.
  std::size_t pose_node_count(mcap::Bytes message);
  std::int64_t pose_time_ns(mcap::Bytes message);
  std::int64_t colliders_time_ns(mcap::Bytes message);
  /// An id that occurs twice is malformed.
  void colliders(mcap::Bytes message, std::vector<ColliderSample>& colliders);
  /// The text in it is valid until the next call.
  TraceEvent event(mcap::Bytes message);

 private:
  template <typename Table>
  const Table& verified(mcap::Bytes message);

  std::vector<std::uint64_t> aligned_;  ///< a message begins anywhere in its chunk; FlatBuffers want alignment
  std::vector<std::uint32_t> ids_;
};

}  // namespace vestige
