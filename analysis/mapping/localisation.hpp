#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "detector/actuator_layout.hpp"
#include "detector/held_amplitudes.hpp"

namespace vestige {

/// Where several actuators together are felt, a model: the middle of their places weighed by
enum class Centroid {
  kAmplitude,  ///< A_i: Σ A_i x_i / Σ A_i. Between two actuators a distance L apart, over all places between them, its
               ///< root mean square error is 0.289 L under `binary` and 0.107 L under `phantom`
  kEnergy,  ///< A_i²: what `phantom` assumes, whose error is therefore 0 between actuators, by construction
};

/// The way from a contact to where it is felt, metres along the body: Σ w_i v_i / Σ w_i, v_i being the way along the
/// surface to actuator i as the contact sees it (`ActuatorLayout::towards_m`): the first step towards the middle on a
/// curved surface (Karcher 1977), the middle itself on a flat one. `shares` is not empty.
glm::dvec2 felt_offset_m(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares,
                         Centroid centroid);

/// The spatial acuity of the torso for vibration, metres: 25 mm, the middle of what was found, but 10 mm within 25 mm
/// of the body's midline (van Erp 2005, "Vibrotactile spatial acuity on the torso"). `middle_x_m`: of the body at rest.
double acuity_m(const glm::dvec3& position_m, double middle_x_m);

}  // namespace vestige
