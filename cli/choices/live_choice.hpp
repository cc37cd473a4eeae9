#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/choices/scene.hpp"
#include "cli/options.hpp"
#include "traces/live/live_recording.hpp"
#include "traces/recording/recorder.hpp"
#include "traces/scene/stance.hpp"

namespace vestige::cli {

/// The sources of live input.
struct LiveChoice {
  std::vector<std::string> sources;  ///< of each person "-", or vmc://HOST:PORT; empty if nothing is live
  bool is_live() const { return !sources.empty(); }
  bool is_lines() const { return sources == std::vector<std::string>{"-"}; }
};

/// A person whose motion comes in live.
struct LivePerson {
  const Avatar& avatar;
  Stance stance;
};

/// Adds --live, which `people_choices` reads.
void add_live_options(CLI::App& verb);

/// Throws `UsageError` if a source is not valid, if only some people have one, or for flags of `verb` that would have
/// no effect beside it.
void check_live_choice(const CLI::App& verb, const LiveChoice& choice);

/// Records until the source ends, the duration ends, the recorder is full, or the user stops it. Ignores
/// `settings.asked`. Warns of lost data. Does not finish the recorder. Throws `Error` if no frame arrived. Each person
/// has a source.
LiveCounts record_live(const LiveChoice& choice, std::span<const LivePerson> people, Recorder& recorder,
                       LiveSettings settings, const glm::dvec3& origin_m, Verbosity verbosity);

}  // namespace vestige::cli
