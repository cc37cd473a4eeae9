#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/batch_plan.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// The result of one trace of the batch.
struct BatchItem {
  std::size_t trace = 0;  ///< its position in the plan
  bool earlier = false;   ///< an earlier run finished it
  nlohmann::ordered_json result;
};

struct BatchOutcome {
  std::vector<BatchItem> items;  ///< finished items, in the order of the traces
  std::vector<BatchFailure> failures;
  bool interrupted = false;
};

struct BatchProgress {
  double share = 0;  ///< share done, by bytes of traces
  std::size_t finished = 0;
  std::size_t traces = 0;
};

/// Runs the detector once on each trace of the shard, and scores all maps with all laws on the trace's contacts. Runs
/// `jobs` traces at a time. Skips traces that an earlier run finished. Writes items, contacts and scenarios' traces.
/// `make_detector` is called by several threads at a time. `progress` is called about ten times a second, and returns
/// false to stop. A trace that cannot be used becomes a failure. Throws `Error` for a problem that concerns all traces
/// (a full disk, a detector that cannot be made). Finished items stay in the folder after a stop or an error.
BatchOutcome run_batch(const BatchPlan& plan, const Shard& shard, const BatchFolder& folder, std::size_t jobs,
                       const std::function<std::unique_ptr<Detector>()>& make_detector,
                       const std::function<bool(const BatchProgress&)>& progress);

}  // namespace vestige
