#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "analysis/run/playback.hpp"
#include "cli/choices/scene.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/vest_options.hpp"
#include "cli/vest/vests.hpp"

namespace vestige::cli {

/// A playback that has ended, and those who felt it.
struct Streamed {
  const StreamOptions& options;
  const OpenTrace& trace;
  const Wearers& wearers;  ///< in the order of the playback's people
  PlaybackResult playback = {};
};

nlohmann::ordered_json to_json(const Streamed& streamed, const Invocation& invocation);

std::string summary(const Streamed& streamed);

/// Says on standard error what went wrong on the way; returns the exit code.
int report_losses(const Streamed& streamed);

}  // namespace vestige::cli
