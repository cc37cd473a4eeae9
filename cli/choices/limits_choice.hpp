#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "traces/recording/recorder.hpp"

namespace vestige::cli {

/// The flags for how a recording ends, continues in another file, or forgets old data.
struct LimitsChoice {
  std::optional<double> ring_s;
  std::string max_size;
  std::string split;
  bool sync = false;
};

/// Adds --ring, --max-size, --split and --sync.
void add_limits_options(CLI::App& verb, LimitsChoice& choice);

/// Throws `UsageError` with the name of the flag for invalid values, and for flags that contradict each other or
/// `output`.
RecordingLimits limits_of(const LimitsChoice& choice, const std::string& output);

/// Parses "1000", "64MiB", "1.5GB" to bytes, at least 1. Throws `UsageError` with the name of the flag.
std::uint64_t parse_size(const std::string& text, const std::string& flag);

}  // namespace vestige::cli
