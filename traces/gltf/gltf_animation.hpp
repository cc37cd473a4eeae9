#pragma once

#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_morph.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// Fills `animations`, in file order. Fails if times do not strictly increase, values do not match the times, two
/// channels animate one property, or an animated node has a `matrix`. Says in `Animation::morph` whether the weights of
/// `morphs` move the skin. Ignores all other properties than translation, rotation and scale, with a warning.
void read_animations(const Document& document, MorphTargets& morphs, Avatar& avatar, Report& report);

}  // namespace vestige::gltf
