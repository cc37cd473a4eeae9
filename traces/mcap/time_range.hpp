#pragma once

#include <cstdint>
#include <optional>

namespace vestige::mcap {

/// A range of message times: from_ns <= log_time < to_ns.
struct TimeRange {
  std::uint64_t from_ns = 0;
  std::optional<std::uint64_t> to_ns = {};  ///< nothing: up to the end, including the largest 64-bit time

  bool contains(std::uint64_t time_ns) const { return overlaps(time_ns, time_ns); }
  bool overlaps(std::uint64_t first_ns, std::uint64_t last_ns) const {
    return from_ns <= last_ns && (!to_ns || first_ns < *to_ns);
  }
};

}  // namespace vestige::mcap
