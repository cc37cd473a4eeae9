#pragma once

#include <string_view>
#include <vector>

#include "traces/scenarios/scenarios.hpp"

namespace vestige::test {

/// Returns the names of all scenarios, in the order of listing.
inline std::vector<std::string_view> scenario_names() {
  std::vector<std::string_view> names;
  names.reserve(scenarios().size());
  for (const Scenario& scenario : scenarios()) names.push_back(scenario.name);
  return names;
}

}  // namespace vestige::test
