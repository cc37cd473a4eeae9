#pragma once

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// Fills `animations`, in the file's order. Fails on times that do not strictly increase, values that do not match
/// them, two channels for one property and animated nodes that have a `matrix`; what is neither translation, rotation
/// nor scale is ignored with a warning.
void read_animations(const Document& document, Avatar& avatar, Report& report);

}  // namespace vestige::gltf
