#pragma once

#include <span>
#include <string>

#include "analysis/frequency/sweep.hpp"

namespace vestige {

/// Returns whether several numbers of people were measured.
bool has_crowds(std::span<const SweepSeries> series);

/// Returns, for each detector, a table of the mean time of a frame with each number of people and of colliders, and how
/// many times that of the fewest people it is. Below stand the throughput and the times of stages, where they were
/// measured, and the points that disagreed with their reference.
std::string crowd_table(std::span<const SweepSeries> series, std::uint64_t seed);

}  // namespace vestige
