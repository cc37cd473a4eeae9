#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"

namespace vestige {

/// A model of where several actuators together are felt, as ways from the contact, metres along the body.
struct FeltOffset {
  /// Σ A_i v_i / Σ A_i. For contacts at all places between two actuators a distance L apart, its root mean square is
  /// 0.289 L under `binary` and 0.107 L under `phantom`.
  glm::dvec2 amplitude_m = glm::dvec2(0);
  /// Σ A_i² v_i / Σ A_i². `phantom` assumes this formula, so under it the value is 0 between actuators on flat skin,
  /// and little on curved skin.
  glm::dvec2 energy_m = glm::dvec2(0);
};

/// Returns the felt offset of a contact. v_i is the way along the surface to actuator i as the contact sees it
/// (`ActuatorLayout::towards_m`). On a flat surface, the result is the exact middle. On a curved surface, it is the
/// first step towards the middle (Karcher 1977). `shares` must not be empty.
FeltOffset felt_offset(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares);

/// Returns the spatial acuity of the torso for vibration, in metres: 10 mm within 25 mm of the body's midline,
/// otherwise 25 mm, the middle of the measured values (van Erp 2005, "Vibrotactile spatial acuity on the torso").
/// `middle_x_m` is the midline of the body at rest. Both are those of a body that is turned to face +z.
double acuity_m(const glm::dvec3& position_m, double middle_x_m);

}  // namespace vestige
