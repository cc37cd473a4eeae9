#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "traces/base/csv.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// One row of a collider CSV. Frame and teleport are only in files that a trace was exported to.
struct ColliderRow {
  std::uint64_t frame = 0;
  double time_s = 0;
  ColliderSample sample;
  bool teleported = false;
};

enum class ColliderColumns {
  kTimes,   ///< time_s,id,x,y,z
  kFrames,  ///< frame,time_s,id,x,y,z,teleported
};

inline constexpr std::string_view kColliderTimesHeader = "time_s,id,x,y,z";
inline constexpr std::string_view kColliderFramesHeader = "frame,time_s,id,x,y,z,teleported";

/// Reads a collider CSV of either header, a row at a time. Throws `Error` naming file and line: another header, a wrong
/// number of columns, no number, not finite, farther than 1e9 m, frames or times that run back.
class ColliderRows {
 public:
  explicit ColliderRows(const std::filesystem::path& path);
  bool next(ColliderRow& row);
  /// What errors are to name.
  const std::string& name() const { return reader_.name(); }
  ColliderColumns columns() const { return columns_; }
  Error error(std::string_view cause, std::string_view remedy) const { return lines_.error(cause, remedy); }

 private:
  LineReader reader_;
  CsvLines lines_;
  ColliderColumns columns_ = ColliderColumns::kTimes;
  std::uint64_t rows_ = 0;
  std::uint64_t last_frame_ = 0;
  double last_time_s_ = 0;
};

/// Puts the rows of `frame,time_s,…` files back into frames; holds one row.
class ColliderFrames {
 public:
  explicit ColliderFrames(const std::filesystem::path& path) : rows_(path) { advance(); }
  ColliderColumns columns() const { return rows_.columns(); }

  /// Fills colliders and teleported ids of the frame of this index and time. Indices grow from call to call. Throws
  /// `Error` where the file has a frame between two indices asked for, an id twice, or another time for this frame.
  void fill(TraceFrame& frame);
  /// Throws `Error` where rows are left.
  void expect_end() const;

 private:
  void advance();

  ColliderRows rows_;
  std::optional<ColliderRow> ahead_;
  std::unordered_set<std::uint32_t> ids_;  ///< of the frame so far
};

}  // namespace vestige
