#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "traces/base/csv.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What a node is called in the columns of a pose CSV, each otherwise than all others: its name, line ends as spaces;
/// behind it `#INDEX` where the name is empty or another node is called so too.
std::vector<std::string> pose_csv_nodes(const std::vector<std::string>& node_names);

/// The ten columns of a node: NODE.tx, .ty, .tz, .rx, .ry, .rz, .rw, .sx, .sy, .sz.
inline constexpr const char* kPoseCsvParts[] = {"tx", "ty", "tz", "rx", "ry", "rz", "rw", "sx", "sy", "sz"};

/// Reads `frame,time_s,origin_x,origin_y,origin_z,NODE.tx,…`, a row a frame, as `make_pose_csv` writes it, one row at a
/// time. Columns may come in any order; all but `time_s` may be missing: frames are counted then, the origin is 0, and
/// a node's part keeps the avatar's rest. Throws `Error` naming file and line: no such node, a column twice, a wrong
/// number of fields, no number, not finite, frames or times that run back, a rotation of length 0, no row.
class PoseCsvReader {
 public:
  PoseCsvReader(const std::filesystem::path& path, const Avatar& avatar);

  /// Index, time and pose of the next frame; false at the end.
  bool next(TraceFrame& frame);
  double share() const { return reader_.share(); }
  /// Nodes without any column, which rest.
  const std::vector<std::string>& resting() const { return resting_; }

 private:
  enum class Column { kFrame, kTime, kOrigin, kNode };
  struct Target {
    Column column = Column::kTime;
    std::size_t node = 0;
    std::size_t part = 0;  ///< of kPoseCsvParts, or of the origin
  };

  void read_header();
  void take(const Target& target, TraceFrame& frame);
  void check(const TraceFrame& frame);

  LineReader reader_;
  CsvLines lines_;
  const Avatar& avatar_;
  Pose rest_;
  std::vector<std::string> columns_;
  std::vector<Target> targets_;
  std::vector<std::string> resting_;
  double time_s_ = 0;
  bool has_frames_ = false;
  std::uint64_t rows_ = 0;
  std::uint64_t last_index_ = 0;
  std::int64_t last_time_ns_ = 0;
};

}  // namespace vestige
