#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "analysis/stress/stress.hpp"

namespace vestige {

/// Returns `families[…]` of a stress run: name, variant, magnitude, detector, method and the counts of `StressCount`.
nlohmann::ordered_json to_json(std::span<const StressCount> counts);

/// Returns a table for people, with a row for each family and magnitude, and a column for each detector and method.
std::string stress_table(std::span<const StressCount> counts);

/// Returns one line for each family that says what the family is and what its magnitudes are.
std::string family_definitions();

}  // namespace vestige
