#pragma once

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// Fills `animations`, in file order. Fails if times do not strictly increase, values do not match the times, two
/// channels animate one property, or an animated node has a `matrix`. Ignores other properties than translation,
/// rotation and scale, with a warning.
void read_animations(const Document& document, Avatar& avatar, Report& report);

}  // namespace vestige::gltf
