#pragma once

#include <span>

namespace vestige {

/// How evenly actuators are used, 0 … 1: -Σ p_i log2 p_i / log2 n, p_i being an actuator's part in all that is used
/// (Shannon 1948; Pielou 1966, evenness). 1: all alike. NaN for fewer than two actuators, or no use.
double use_evenness(std::span<const double> use);

}  // namespace vestige
