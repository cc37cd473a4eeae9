#pragma once

#include <cstdint>
#include <string>

#include "cli/options.hpp"

namespace vestige::cli {

/// Records the trace that verbs measure on if none is given: the built-in avatar in a swarm of this many colliders,
/// written to `path`.
void record_default_trace(const std::string& path, std::uint32_t colliders, const CommonOptions& options,
                          const Invocation& invocation);

}  // namespace vestige::cli
