#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traces/base/csv.hpp"
#include "traces/exchange/convention.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Returns the unique column names of the nodes in a pose CSV: the node's name, with line ends replaced by spaces.
/// `#INDEX` follows if the name is empty or another node has the same name.
std::vector<std::string> pose_csv_nodes(const std::vector<std::string>& node_names);

/// The endings of a node's ten columns: NODE.tx, .ty, .tz, .rx, .ry, .rz, .rw, .sx, .sy, .sz.
inline constexpr const char* kPoseCsvParts[] = {"tx", "ty", "tz", "rx", "ry", "rz", "rw", "sx", "sy", "sz"};

/// Reads `frame,time_s,origin_x,origin_y,origin_z,NODE.tx,…` as `make_pose_csv` writes it: one row for each frame, one
/// row at a time. Columns may come in any order, and all but `time_s` may be missing. Without `frame`, frames are
/// counted. A missing origin is 0. A missing part of a node keeps the avatar's rest value. Numbers are changed from
/// their `Convention` to the trace's. Throws `Error` with file and line: an unknown node, a column twice, a wrong
/// number of fields, a field that is not a number, not finite, frames or times that decrease, a rotation of length 0,
/// no row.
class PoseCsvReader {
 public:
  PoseCsvReader(const std::filesystem::path& path, const Avatar& avatar, const Convention& convention = {});

  /// Reads index, time and pose of the next frame. Returns false at the end.
  bool next(TraceFrame& frame);
  double share() const { return reader_.share(); }
  /// Nodes without any column; they stay in the rest pose.
  const std::vector<std::string>& resting() const { return resting_; }
  /// Returns whether each node has a column that says where it is.
  std::vector<bool> placed() const;

 private:
  enum class Column { kFrame, kTime, kOrigin, kNode };
  struct Target {
    Column column = Column::kTime;
    std::size_t node = 0;
    std::size_t part = 0;  ///< index into kPoseCsvParts, or into the origin
  };

  void read_header();
  void take(const Target& target, TraceFrame& frame);
  void check(const TraceFrame& frame);
  void change_convention(TraceFrame& frame) const;

  LineReader reader_;
  CsvLines lines_;
  const Avatar& avatar_;
  Convention convention_;
  Pose rest_;  ///< nodes with a column are in the file's convention
  std::vector<std::string> columns_;
  std::vector<Target> targets_;
  std::vector<std::string> resting_;
  std::vector<bool> moves_;  ///< for each node: whether it has a column
  double time_s_ = 0;
  bool has_frames_ = false;
  std::uint64_t rows_ = 0;
  std::uint64_t last_index_ = 0;
  std::int64_t last_time_ns_ = 0;
};

}  // namespace vestige
