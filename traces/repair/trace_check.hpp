#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/check/container_check.hpp"
#include "traces/mcap/check/problem.hpp"

namespace vestige {

/// The result of `vestige doctor` for a file.
struct TraceCheck {
  struct Attachment {
    std::string name;
    std::string sha256;               ///< 64 hexadecimal digits
    std::optional<bool> is_recorded;  ///< whether this is the recorded SHA-256; nothing: none is recorded
  };
  bool is_trace = false;  ///< judged by profile or channels; any other MCAP file is checked as a container only
  mcap::ContainerFacts container;
  std::size_t people = 1;               ///< see `people_of`
  std::uint64_t frames = 0;             ///< frames that readers deliver, up to the first one that they refuse
  std::uint64_t dropped = 0;            ///< number of messages that the recorder noted as lost
  std::vector<Attachment> attachments;  ///< the undamaged ones, by name
  mcap::ProblemList problems;

  /// Whether anything is readable: a frame of a trace; a message, attachment or metadata record of another file.
  bool readable() const {
    if (is_trace) return frames > 0;
    return container.messages + container.attachments + container.metadata > 0;
  }
};

/// Checks a file as `mcap::check_container` does. In a Vestige trace, also checks session and attachments, every
/// message against its schema, and frames against the avatar and each other. Throws `Error` if the source is empty,
/// reading failed, or `progress` stopped the check.
TraceCheck check_trace(const mcap::ByteSource& source, const std::function<bool(double)>& progress);

}  // namespace vestige
