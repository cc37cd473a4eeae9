#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/live/datagram_input.hpp"
#include "analysis/live/live_run.hpp"
#include "analysis/live/realtime.hpp"
#include "cli/choices/limits_choice.hpp"
#include "cli/facing_flag.hpp"
#include "cli/options.hpp"
#include "cli/vest/live_recorder.hpp"
#include "cli/vest/vest_options.hpp"
#include "cli/vest/vests.hpp"
#include "transport/latency_histogram.hpp"

namespace vestige::cli {

/// What `vestige live` is asked for.
struct LiveVerbOptions : VestOptions {
  std::vector<std::string> sources;
  std::vector<std::string> avatars;
  FacingChoice facing;
  std::string pose = "interpolate";
  std::optional<double> rate_hz;
  std::optional<double> duration_s;
  std::string record;
  LimitsChoice limits;
  bool realtime = false;

  PoseShown pose_shown() const { return pose == "latest" ? PoseShown::kLatest : PoseShown::kInterpolate; }
};

/// How long frames took, from their arrival on.
struct LiveLatency {
  LatencyHistogram decoded;     ///< until they could be detected
  LatencyHistogram detected;    ///< until their contacts were found
  LatencyHistogram pose_delay;  ///< how late their poses were shown, by --pose interpolate
  LatencyHistogram interval;    ///< between two frames

  void add(const LiveMoments& moments);
};

/// A live session that has ended.
struct LiveSession {
  const LiveVerbOptions& options;
  const std::vector<TracedPerson>& people;
  const Wearers& wearers;  ///< in the order of the result's people
  LiveLatency latency = {};
  std::optional<RealTime> real_time = {};
  const LiveRecorder* recorder = nullptr;  ///< null: nothing is recorded
  LiveResult result = {};
};

nlohmann::ordered_json to_json(const LiveSession& session, const Invocation& invocation);

std::string summary(const LiveSession& session);

/// Says on standard error what went wrong; returns the exit code.
int report_losses(const LiveSession& session);

}  // namespace vestige::cli
