#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/options.hpp"
#include "traces/live/live_recording.hpp"
#include "traces/recording/recorder.hpp"

namespace vestige::cli {

/// The source of live input.
struct LiveChoice {
  std::string source;  ///< "-", or vmc://HOST:PORT; empty if nothing is live
  bool is_live() const { return !source.empty(); }
  bool is_lines() const { return source == "-"; }
};

/// Adds --live.
void add_live_options(CLI::App& verb, LiveChoice& choice);

/// Throws `UsageError` if the source is not valid, or for flags of `verb` that would have no effect beside it.
void check_live_choice(const CLI::App& verb, const LiveChoice& choice);

/// Records until the source ends, the duration ends, the recorder is full, or the user stops it. Ignores
/// `settings.asked`. Warns of lost data. Does not finish the recorder. Throws `Error` if no frame arrived.
LiveCounts record_live(const LiveChoice& choice, const Scene& scene, Recorder& recorder, LiveSettings settings,
                       const glm::dvec3& origin_m, Verbosity verbosity);

}  // namespace vestige::cli
