#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "analysis/stress/stress.hpp"

namespace vestige {

/// `families[…]` of a stress run: name, variant, magnitude, detector, method and the counts of `StressCount`.
nlohmann::ordered_json to_json(std::span<const StressCount> counts);

/// The table for people: a row for each family and magnitude, a column for each detector and method.
std::string stress_table(std::span<const StressCount> counts);

/// One line a family: what it is, and what its magnitudes are.
std::string family_definitions();

}  // namespace vestige
