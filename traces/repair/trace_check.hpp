#pragma once

#include <cstdint>
#include <functional>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/check/container_check.hpp"
#include "traces/mcap/check/problem.hpp"

namespace vestige {

/// What `vestige doctor` says of a file.
struct TraceCheck {
  bool is_trace = false;  ///< by its profile or its channels; another MCAP file is checked as a container only
  mcap::ContainerFacts container;
  std::uint64_t frames = 0;   ///< that readers deliver: up to where one of them is refused
  std::uint64_t dropped = 0;  ///< messages that the recorder noted as lost
  mcap::ProblemList problems;

  /// Whether there is anything left to read: a frame of a trace; a message, attachment or metadata of another file.
  bool readable() const {
    if (is_trace) return frames > 0;
    return container.messages + container.attachments + container.metadata > 0;
  }
};

/// Checks a file as `mcap::check_container` does, and on top of that, in a trace of ours: session and attachments,
/// every message against its schema, frames against the avatar and against each other. Throws `Error`: the source is
/// empty, reading failed, stopped by `progress`.
TraceCheck check_trace(const mcap::ByteSource& source, const std::function<bool(double)>& progress);

}  // namespace vestige
