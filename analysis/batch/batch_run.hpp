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

/// What came of one trace of the batch.
struct BatchItem {
  std::size_t trace = 0;  ///< its position in the plan
  bool earlier = false;   ///< finished by an earlier run
  nlohmann::ordered_json result;
};

struct BatchOutcome {
  std::vector<BatchItem> items;  ///< finished, in the order of the traces
  std::vector<BatchFailure> failures;
  bool interrupted = false;
};

struct BatchProgress {
  double share = 0;  ///< done, by bytes of traces
  std::size_t finished = 0;
  std::size_t traces = 0;
};

/// Detects each trace of the shard once and scores all maps with all laws on its contacts, `jobs` traces at a time;
/// what an earlier run finished is left as it is. Writes items, contacts and scenarios' traces. `make_detector` is
/// called by several threads at a time. `progress` is called about ten times a second, and returns false to stop; then
/// finished items stay. A trace that cannot be used becomes a failure; what concerns all of them (a full disk, a
/// detector that cannot be made) throws `Error`, and finished items stay.
BatchOutcome run_batch(const BatchPlan& plan, const Shard& shard, const BatchFolder& folder, std::size_t jobs,
                       const std::function<std::unique_ptr<Detector>()>& make_detector,
                       const std::function<bool(const BatchProgress&)>& progress);

}  // namespace vestige
