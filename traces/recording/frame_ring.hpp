#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "traces/mcap/encode.hpp"
#include "traces/scene/trace.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {

/// What is noted beside frames.
struct RecordingNote {
  enum class Kind : std::uint8_t { kDropped, kMarker };
  Kind kind = Kind::kDropped;
  std::uint64_t count = 0;  ///< messages lost
  std::string text = {};    ///< their topic, or the marker
};

/// The last seconds of a recording, in memory: frames as the messages that they will be in a trace, compressed by
/// blocks. What comes out is what went in, to the bit.
class FrameRing {
 public:
  struct Limits {
    double seconds = std::numeric_limits<double>::infinity();  ///< of the frames' own time
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  };

  /// Frames and notes of one moment, which stay while the ring goes on.
  class Contents {
   public:
    using TakeNote = std::function<void(const RecordingNote&)>;
    /// Returns false to stop.
    using TakeFrame = std::function<bool(const TraceFrame&)>;

    /// Notes come before the frame that they were pushed before.
    void for_each(const TakeNote& take_note, const TakeFrame& take_frame) const;

   private:
    friend class FrameRing;
    struct Block {
      std::vector<std::byte> bytes;  ///< compressed
      std::size_t expanded_bytes = 0;
      std::int64_t last_ns = 0;
    };
    std::deque<std::shared_ptr<const Block>> blocks_;
    std::int64_t first_ns_ = 0;  ///< frames before it have left the ring
  };

  explicit FrameRing(const Limits& limits) : limits_(limits) {}

  void push(const RecordingNote& note);
  /// Precondition: times do not decrease.
  void push(const TraceFrame& frame);

  /// Cheap: shares the blocks.
  Contents contents();
  /// What it takes: at most a block, of 1 MiB or one frame, more than the limit.
  std::uint64_t bytes() const { return bytes_ + open_.size(); }
  /// Whether frames had to go for want of room that `Limits::seconds` would have kept.
  bool is_cut_by_size() const { return is_cut_by_size_; }

 private:
  void close_block();
  void forget_old();
  std::int64_t first_kept_ns() const;

  Limits limits_;
  MessageEncoder encoder_;
  mcap::ByteBuffer open_;  ///< records of the block being filled
  Contents contents_;
  std::uint64_t bytes_ = 0;  ///< of closed blocks
  std::int64_t last_ns_ = 0;
  bool is_cut_by_size_ = false;
};

}  // namespace vestige
