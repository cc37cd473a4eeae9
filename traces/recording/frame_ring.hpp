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

/// A note that is recorded beside the frames.
struct RecordingNote {
  enum class Kind : std::uint8_t { kDropped, kSuperseded, kMarker };
  Kind kind = Kind::kDropped;
  std::uint64_t count = 0;  ///< number of messages lost, or of frames superseded
  std::string text = {};    ///< topic of the lost messages, or text of the marker
};

/// The last seconds of a recording, in memory. Frames are stored as the messages that a trace would hold, in compressed
/// blocks. Frames come out equal to the bit to the frames that went in.
class FrameRing {
 public:
  struct Limits {
    double seconds = std::numeric_limits<double>::infinity();  ///< measured by the frames' own times
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
  };

  /// The ring's frames and notes at one moment. Later changes of the ring do not affect them.
  class Contents {
   public:
    using TakeNote = std::function<void(const RecordingNote&)>;
    /// Returns false to stop.
    using TakeFrame = std::function<bool(const TraceFrame&)>;

    /// Delivers all in order; a note comes before the frame that was pushed after it.
    void for_each(const TakeNote& take_note, const TakeFrame& take_frame) const;

   private:
    friend class FrameRing;
    struct Block {
      std::vector<std::byte> bytes;  ///< compressed
      std::size_t expanded_bytes = 0;
      std::int64_t last_ns = 0;
    };
    std::deque<std::shared_ptr<const Block>> blocks_;
    std::int64_t first_ns_ = 0;  ///< frames before this time have left the ring
  };

  explicit FrameRing(const Limits& limits) : limits_(limits) {}

  void push(const RecordingNote& note);
  /// Precondition: times do not decrease.
  void push(const TraceFrame& frame);

  /// Cheap, because the result shares the blocks.
  Contents contents();
  /// Memory in use. Exceeds the limit by at most one block, of 1 MiB or one frame.
  std::uint64_t bytes() const { return bytes_ + open_.size(); }
  /// Whether the size limit removed frames that `Limits::seconds` would have kept.
  bool is_cut_by_size() const { return is_cut_by_size_; }

 private:
  void close_block();
  void forget_old();
  std::int64_t first_kept_ns() const;

  Limits limits_;
  MessageEncoder encoder_;
  mcap::ByteBuffer open_;  ///< records of the block being filled
  Contents contents_;
  std::uint64_t bytes_ = 0;  ///< size of the closed blocks
  std::int64_t last_ns_ = 0;
  bool is_cut_by_size_ = false;
};

}  // namespace vestige
