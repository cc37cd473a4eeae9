#pragma once

#include <span>

namespace vestige {

/// Returns how evenly actuators are used, 0 … 1: -Σ p_i log2 p_i / log2 n, where p_i is actuator i's share of all use
/// (Shannon 1948; Pielou 1966, evenness). 1 means that all are used alike. Returns NaN if there are fewer than two
/// actuators or no use.
double use_evenness(std::span<const double> use);

}  // namespace vestige
