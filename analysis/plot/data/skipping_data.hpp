#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/plot/data/sweep_data.hpp"

namespace vestige::plot {

/// Pairs of collider and triangle, on average over the frames of a sweep, as `cpu` with skipping leaves them out.
struct SkippedPairs {
  double all = 0;      ///< every collider with every triangle
  double open = 0;     ///< not proven apart by an earlier frame
  double tested = 0;   ///< in patches whose box the collider may reach
  double meeting = 0;  ///< that really meet
};

/// The largest number of colliders of one sweep.
struct SkippingGroup {
  std::string name;  ///< of the trace
  double colliders = 0;
  SkippedPairs pairs;
  double us = 0;      ///< of a frame, on average
  double us_off = 0;  ///< the same without skipping; 0 if the sweep did not measure it
};

/// What sweeps say about skipping: a group for each.
struct SkippingResult {
  SweepSource source;  ///< of the first
  std::vector<SkippingGroup> groups;
};

/// Reads sweeps. A path "DIR" stands for DIR/sweep.json. Throws `Error` with file and field, and if a sweep did not
/// measure `cpu` with skipping, did so for several people, or by a version that did not count what it skipped.
SkippingResult read_skipping(const std::vector<std::filesystem::path>& paths);

}  // namespace vestige::plot
