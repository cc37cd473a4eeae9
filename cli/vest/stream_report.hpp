#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/run/playback.hpp"
#include "cli/choices/scene.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/stream_options.hpp"
#include "cli/vest/wearer.hpp"
#include "transport/latency_histogram.hpp"

namespace vestige::cli {

/// A playback that has ended, and those who felt it.
struct Streamed {
  const StreamOptions& options;
  const OpenTrace& trace;
  const std::vector<std::unique_ptr<Wearer>>& wearers;  ///< in the order of the playback's people
  PlaybackResult playback = {};
};

/// Median, 95 %, 99 % and most, in microseconds; and the same for people, in milliseconds.
nlohmann::ordered_json to_json(const LatencyHistogram& latency);
std::string describe(const LatencyHistogram& latency);

nlohmann::ordered_json to_json(const Streamed& streamed, const Invocation& invocation);

std::string summary(const Streamed& streamed);

/// Says on standard error what went wrong on the way; returns the exit code.
int report_losses(const Streamed& streamed);

}  // namespace vestige::cli
