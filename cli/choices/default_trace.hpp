#pragma once

#include <cstdint>
#include <string>

#include "cli/options.hpp"

namespace vestige::cli {

/// What verbs measure on where no trace is given: the built-in avatar in a swarm of so many colliders, written to
/// `path`.
void record_default_trace(const std::string& path, std::uint32_t colliders, const CommonOptions& options,
                          const Invocation& invocation);

}  // namespace vestige::cli
