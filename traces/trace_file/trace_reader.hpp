#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// A person of a trace. The bytes belong to the reader.
struct RecordedPerson {
  std::string name;    ///< empty: the trace names nobody
  std::string facing;  ///< which way the avatar looks at rest: `take_recorded_facing`; empty: the trace does not say it
  std::span<const std::byte> avatar_glb;
  std::span<const std::byte> actuator_map_png;   ///< empty: the person has none
  std::span<const std::byte> actuator_map_json;  ///< empty: the person has none
  std::vector<std::string> node_names;  ///< of the avatar, in order: each pose of this person has as many nodes
};

/// What a caller of `TraceReader` can handle. kOne: only traces of one person whose colliders belong to nobody.
enum class People : std::uint8_t { kOne, kSeveral };

/// Reads a trace by its index, or by scanning it if the footer is missing or the summary is broken. Damaged chunks are
/// skipped. A skipped chunk shows as a gap in `TraceFrame::index`, as a warning with its byte offset, and in
/// `complete()`.
///
/// Every function throws `Error` with the name of the file and the offset. Causes: not an MCAP file, not a Vestige
/// trace, a later `format_version`, no avatar or a damaged one, more than a million colliders, more people than the
/// caller can handle. Also a frame that contradicts the rest: frames out of order, time
/// running backwards, another number of nodes than the avatar has, a collider twice.
///
/// Where a person's pose is missing, the frame is delivered without it, and a warning says so. A frame in which every
/// pose is missing is left out.
class TraceReader {
 public:
  /// "-" is standard input, which is copied to a nameless temporary file. With several threads, those other than the
  /// calling one expand chunks ahead.
  explicit TraceReader(const std::filesystem::path& path, People allowed = People::kOne, std::size_t threads = 1);
  ~TraceReader();
  TraceReader(const TraceReader&) = delete;
  TraceReader& operator=(const TraceReader&) = delete;

  const Session& session() const;
  /// The people in the order of `TraceFrame::poses`, at least one.
  const std::vector<RecordedPerson>& people() const;
  /// Whether the trace's colliders may have a radius: kPoints in format version 1.
  ColliderShape shape() const;
  /// Whether the trace's colliders may belong to people: kNone in format versions 1 and 2.
  Owners owners() const;

  /// The ids of all colliders in the trace, ascending. The first call of this or the next three functions reads the
  /// whole trace once, without decoding poses, and throws `Error` if a collider changes its owner. `next` still
  /// continues where it was.
  const std::vector<std::uint32_t>& collider_ids();
  /// The ids of the colliders that have a radius in some frame, ascending.
  const std::vector<std::uint32_t>& sphere_ids();
  /// Whether any collider has a radius above 0 in any frame. A file that holds radii may hold only those of points.
  bool has_spheres() { return !sphere_ids().empty(); }
  /// The total number of frames that `next` delivers.
  std::uint64_t frame_count();
  /// The number of messages that the recorder noted as lost.
  std::uint64_t dropped();

  /// Reads the next frame in order. Returns false at the end. Reuses the memory of `frame`. `frame.time_ns` is the
  /// message's log_time.
  bool next(TraceFrame& frame);
  void rewind();

  /// Whether the trace has a footer and everything read so far was undamaged. Final once `next` has returned false or
  /// `frame_count` has been called.
  bool complete() const;
  /// Faults of the file, one sentence each, with byte offset. The list grows while reading and holds each fault once.
  const std::vector<std::string>& warnings() const;
  /// The note that `recover` left if it wrote this file from a damaged one: see `describe_recovered`. Otherwise empty.
  const std::string& recovered() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Throws `Error` with the reason if the trace holds no frame.
void require_frames(TraceReader& trace, const std::string& name);

/// Returns the faults of a trace that is not `complete()`: its warnings, or one sentence with `name` if there are no
/// warnings. Empty for a complete trace.
std::vector<std::string> damage_of(const TraceReader& trace, std::string_view name);

}  // namespace vestige
