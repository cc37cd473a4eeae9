#pragma once

#include <string>

#include "traces/mcap/record.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {

/// Writes messages as JSON, each on one line: `{"topic", "sequence", "log_time", "publish_time", "data"}`, times in
/// nanoseconds. `data` of Vestige's own messages:
///
///     /pose       {"origin": [x, y, z], "nodes": [[tx, ty, tz, rx, ry, rz, rw, sx, sy, sz], …]}
///     /colliders  [{"id", "position": [x, y, z]}, …]
///     /events     {"kind", "collider", "count", "text"}
///
/// `data` of foreign messages: a message encoded as JSON is copied without the white space between its tokens; any
/// other message has `data_base64` instead of `data`. Floats have the shortest text that reads back to the same bits.
/// NaN and infinities are the strings "nan", "inf" and "-inf".
class MessageText {
 public:
  /// Returns the line without its end. Throws `mcap::Malformed` if one of Vestige's own messages cannot be decoded.
  std::string line(const mcap::Message& message, const mcap::Channel& channel, trace_format::Stream stream);

 private:
  void append_data(const mcap::Message& message, const mcap::Channel& channel, trace_format::Stream stream);
  void append_pose(mcap::Bytes data);
  void append_colliders(mcap::Bytes data);
  void append_event(mcap::Bytes data);
  void append_foreign(mcap::Bytes data, const mcap::Channel& channel);

  std::string text_;
  MessageDecoder decoder_;
  Pose pose_;
  std::vector<ColliderSample> colliders_;
};

}  // namespace vestige
