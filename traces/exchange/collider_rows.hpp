#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "traces/base/csv.hpp"
#include "traces/exchange/convention.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// One row of a collider CSV. `frame` and `teleported` exist only in exports of a trace.
struct ColliderRow {
  std::uint64_t frame = 0;
  double time_s = 0;
  ColliderSample sample;
  bool teleported = false;
};

enum class ColliderColumns {
  kTimes,   ///< time_s,id,x,y,z[,radius_m][,owner]
  kFrames,  ///< frame,time_s,id,x,y,z[,radius_m][,owner],teleported
};

/// Returns the header of a collider CSV. Spheres have the column radius_m. With owners there is the column owner: 0 for
/// nobody, otherwise the number of a person.
std::string collider_header(ColliderColumns columns, ColliderShape shape, Owners owners);

/// Reads a collider CSV with one of these headers, one row at a time, and changes its numbers from their
/// `Convention` to metres, seconds and the trace's axes. Throws `Error` with file and line: another header, a wrong
/// number of columns, a field that is not a number, not finite, farther than 1e9 m, a radius that is negative or larger
/// than 10 m, frames or times that decrease, an id with another owner than before, an owner beyond `people`.
class ColliderRows {
 public:
  explicit ColliderRows(const std::filesystem::path& path, const Convention& convention = {},
                        std::size_t people = kMostOwners);
  bool next(ColliderRow& row);
  /// The name that error messages use.
  const std::string& name() const { return reader_.name(); }
  ColliderColumns columns() const { return columns_; }
  ColliderShape shape() const { return shape_; }
  Owners owners() const { return owners_; }
  Error error(std::string_view cause, std::string_view remedy) const { return lines_.error(cause, remedy); }

 private:
  void take_header();
  void take_fields(ColliderRow& row);
  void check_order(const ColliderRow& row) const;
  void check_owner(const ColliderSample& sample);

  LineReader reader_;
  CsvLines lines_;
  Convention convention_;
  ColliderColumns columns_ = ColliderColumns::kTimes;
  ColliderShape shape_ = ColliderShape::kPoints;
  Owners owners_ = Owners::kNone;
  std::size_t people_;
  std::string remedy_;
  std::unordered_map<std::uint32_t, std::uint16_t> owner_of_;  ///< by id
  std::uint64_t rows_ = 0;
  std::uint64_t last_frame_ = 0;
  double last_time_s_ = 0;
};

/// Groups the rows of `frame,time_s,…` files by frame; holds one row.
class ColliderFrames {
 public:
  explicit ColliderFrames(const std::filesystem::path& path, const Convention& convention = {},
                          std::size_t people = kMostOwners)
      : rows_(path, convention, people) {
    advance();
  }
  ColliderColumns columns() const { return rows_.columns(); }
  ColliderShape shape() const { return rows_.shape(); }
  Owners owners() const { return rows_.owners(); }

  /// Fills in colliders and teleported ids of the frame with this index and time. Indices must increase from call to
  /// call. Throws `Error` if the file has a frame between two requested indices, an id twice, or another time for this
  /// frame.
  void fill(TraceFrame& frame);
  /// Throws `Error` if rows are left.
  void expect_end() const;

 private:
  void advance();

  ColliderRows rows_;
  std::optional<ColliderRow> ahead_;
  std::unordered_set<std::uint32_t> ids_;  ///< ids of the current frame so far
};

}  // namespace vestige
