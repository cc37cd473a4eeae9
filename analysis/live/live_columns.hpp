#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Gives colliders whose ids appear over time columns of a collision texture, in the order in which they appear. A
/// column stays with its collider while that is there, and for 10 s more, in which a law may still hold its contact.
/// Then another collider may get the column, so that a stream of new ids needs no more memory.
class LiveColumns {
 public:
  LiveColumns();

  /// Returns in `out` the frame with columns in the place of ids. Teleports of colliders that are not in the frame are
  /// left out. Returns whether there are more columns now than before.
  bool number(const TraceFrame& frame, TraceFrame& out);

  /// All columns: 0, 1, 2, …
  std::span<const std::uint32_t> columns() const { return columns_; }
  /// The ids of the columns. Those of columns that nobody has had yet are 0.
  std::span<const std::uint32_t> ids() const { return ids_; }
  /// Number of ids so far; an id that comes back after its column went to another counts again.
  std::uint64_t seen() const { return seen_; }

 private:
  struct Place {
    std::uint32_t column = 0;
    std::int64_t last_ns = 0;  ///< time of the last frame that had the collider
  };

  std::uint32_t column_of(std::uint32_t id, std::int64_t time_ns);
  /// Makes free columns: of colliders that are gone, otherwise new ones.
  void make_room(std::int64_t time_ns);

  std::unordered_map<std::uint32_t, Place> place_of_;
  std::vector<std::uint32_t> free_;  ///< columns, the next one last
  std::vector<std::uint32_t> columns_;
  std::vector<std::uint32_t> ids_;
  std::uint64_t seen_ = 0;
};

}  // namespace vestige
