#pragma once

#include <cstddef>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// The colour of actuator `number`, from 1, of `count`; of 0, skin without an actuator. Up to 7 they are those of the
/// collision textures, told apart with every common colour blindness. More differ in hue and, from one number to the
/// next, in lightness.
Colour region_colour(std::size_t number, std::size_t count);

/// Black or white, whichever is read more easily on `ground`.
Colour ink_on(Colour ground);

}  // namespace vestige::plot
