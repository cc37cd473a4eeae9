#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/plot/data/sweep_data.hpp"

namespace vestige::plot {

/// A frame with a number of colliders.
struct StageBar {
  double colliders = 0;
  SweepStages stages;
};

/// The bars of one series of a sweep, by rising number of colliders. There is at least one.
struct StageGroup {
  std::string detector;
  std::string details;  ///< what tells it from others of the detector: context, skipping, method; may be empty
  std::vector<StageBar> bars;
};

/// What a sweep says about stages. There is at least one group.
struct StageResult {
  SweepSource source;
  std::vector<StageGroup> groups;
};

/// Reads a sweep. A path "DIR" stands for DIR/sweep.json. Takes these numbers of colliders, or, if there are none, all
/// of a sweep with up to three, otherwise the least, the middle and the most. Series without stages are left out.
/// Throws `Error` with file and field, and if there are no stages at all, or none with a number in `counts`.
StageResult read_stage_result(const std::filesystem::path& path, const std::vector<std::uint32_t>& counts);

}  // namespace vestige::plot
