#pragma once

#include <vector>

#include "cli/choices/person_value.hpp"
#include "cli/options.hpp"
#include "cli/vest/vest_options.hpp"

namespace vestige::cli {

/// Plays the people of a trace to programs that take the VMC protocol, in real time. Detects nothing. Each of `ports`
/// is vmc://HOST:PORT. The first of the people who have a port also sends the colliders.
void stream_people(const StreamOptions& options, const std::vector<PersonValue>& ports, Invocation& invocation);

}  // namespace vestige::cli
