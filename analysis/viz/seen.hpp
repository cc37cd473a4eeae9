#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/run/seen_run.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

std::vector<const Avatar*> avatars_of(std::span<const MappedPerson> people);

/// Returns the names that duties have in messages: of all actuators, person by person; of a later person "2/NAME".
std::vector<std::string> viz_actuator_names(std::span<const MappedPerson> people);

}  // namespace vestige
