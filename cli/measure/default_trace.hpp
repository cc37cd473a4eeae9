#pragma once

#include <cstdint>
#include <string>

#include "cli/options.hpp"
#include "traces/recording/sampled_scene.hpp"

namespace vestige::cli {

struct DefaultTrace {
  std::uint32_t colliders = 0;
  double duration_s = RecordingSettings().duration_s;
};

/// Records the trace that verbs measure on if none is given: the built-in avatar in a swarm of this many colliders,
/// written to `path`.
void record_default_trace(const std::string& path, const DefaultTrace& trace, const CommonOptions& options,
                          const Invocation& invocation);

}  // namespace vestige::cli
