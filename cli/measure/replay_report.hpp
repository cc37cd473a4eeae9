#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "analysis/run/replay.hpp"
#include "cli/choices/scene.hpp"
#include "cli/command_line.hpp"
#include "cli/measure/replay_options.hpp"
#include "cli/measure/replay_timelines.hpp"
#include "detector/detectors/path_choice.hpp"

namespace vestige::cli {

/// A trace under replay, and what runs it.
struct ReplayRun {
  const ReplayOptions& options;
  const OpenTrace& trace;
  std::size_t colliders;
  std::optional<PickedPath> picked;  ///< by --detector auto
  const DetectorTeam& detectors;
  bool ignores_radii;  ///< of colliders that have one
  const Timelines& timelines;
};

/// Returns what --json writes.
nlohmann::ordered_json to_json(const ReplayResult& result, const ReplayRun& run, const Invocation& invocation);

/// Returns what the terminal shows.
std::string summary(const ReplayResult& result, const ReplayRun& run);

}  // namespace vestige::cli
