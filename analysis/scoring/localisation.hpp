#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"

namespace vestige {

/// Where several actuators together are felt, a model: ways from the contact, metres along the body.
struct FeltOffset {
  /// Σ A_i v_i / Σ A_i. Between two actuators a distance L apart, over all places between them, its root mean square
  /// is 0.289 L under `binary` and 0.107 L under `phantom`.
  glm::dvec2 amplitude_m = glm::dvec2(0);
  /// Σ A_i² v_i / Σ A_i²: what `phantom` assumes, so it is 0 between actuators under that, by construction.
  glm::dvec2 energy_m = glm::dvec2(0);
};

/// v_i is the way along the surface to actuator i as the contact sees it (`ActuatorLayout::towards_m`): so this is the
/// first step towards the middle on a curved surface (Karcher 1977), and the middle itself on a flat one. `shares` is
/// not empty.
FeltOffset felt_offset(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares);

/// The spatial acuity of the torso for vibration, metres: 25 mm, the middle of what was found, but 10 mm within 25 mm
/// of the body's midline (van Erp 2005, "Vibrotactile spatial acuity on the torso"). `middle_x_m`: of the body at rest.
double acuity_m(const glm::dvec3& position_m, double middle_x_m);

}  // namespace vestige
