#pragma once

#include <span>
#include <string>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// A person whom viewers show.
struct VizPerson {
  const Avatar& avatar;
  const ActuatorMap& map;
};

/// What was found on a person in a frame. The row carries `kHashedPlanes` and positions.
struct SeenPerson {
  const DetectorFrame& frame;
  const ContactRow& row;
  const ActuatorFrame* felt = nullptr;  ///< null: the person has no actuator
};

std::vector<const Avatar*> avatars_of(std::span<const VizPerson> people);

/// Returns the names that duties have in messages: of all actuators, person by person; of a later person "2/NAME".
std::vector<std::string> viz_actuator_names(std::span<const VizPerson> people);

}  // namespace vestige
