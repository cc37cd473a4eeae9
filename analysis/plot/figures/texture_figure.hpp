#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/texture_contacts.hpp"

namespace vestige::plot {

/// Draws the collision textures: frames downwards, colliders to the right, each contact in its actuator's colour. A
/// contact is always large enough to be seen, however many frames there are.
std::unique_ptr<Figure> texture_figure(TextureContacts textures);

}  // namespace vestige::plot
