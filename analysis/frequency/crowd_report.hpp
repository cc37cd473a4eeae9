#pragma once

#include <span>
#include <string>

#include "analysis/frequency/sweep.hpp"

namespace vestige {

/// Returns whether several numbers of people were measured.
bool has_crowds(std::span<const SweepSeries> series);

/// Returns, for each detector, a table for people: the mean time of a frame over the number of people, for each count
/// of colliders, and how many times that of the fewest people it is.
std::string crowd_table(std::span<const SweepSeries> series);

}  // namespace vestige
