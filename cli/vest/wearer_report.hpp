#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "analysis/run/felt_frames.hpp"
#include "cli/terminal.hpp"
#include "cli/vest/vests.hpp"
#include "cli/vest/wearer.hpp"
#include "transport/latency_histogram.hpp"
#include "transport/sender.hpp"

namespace vestige::cli {

/// Median, 95 %, 99 % and most, in microseconds, null if there are no latencies; and the same for people, in
/// milliseconds. Precondition of the latter: there are some.
nlohmann::ordered_json to_json(const LatencyHistogram& latency);
std::string describe(const LatencyHistogram& latency);

/// Returns what was sent to all vests together.
SenderStatistics total_of(const Wearers& wearers);

/// Adds what was sent, and how often maps were read again.
void add_to(nlohmann::ordered_json& json, const SenderStatistics& sender, std::uint64_t maps_reloaded);

nlohmann::ordered_json link_of(const Wearer& wearer);

/// Describes in some lines what was sent to a vest. `from` is where its latencies begin: "contact".
std::string summary_of(const Wearer& wearer, std::string_view from);

/// Says on standard error what went wrong on the way to one vest; returns the exit code.
int report_losses(const Wearer& wearer, const FeltPerson& person, Verbosity verbosity);

}  // namespace vestige::cli
