#pragma once

#include <cstddef>

#include "analysis/colours/colour.hpp"

namespace vestige::plot {

/// Returns the colour of actuator `number` (from 1) of `count`. 0 gives the colour of skin without an actuator. Up to 7
/// actuators have the colours of the collision textures, which differ for people with any common colour blindness. With
/// more actuators, colours differ in hue and, from one number to the next, in lightness.
Colour region_colour(std::size_t number, std::size_t count);

/// Returns black or white, whichever is easier to read on `ground`.
Colour ink_on(Colour ground);

}  // namespace vestige::plot
