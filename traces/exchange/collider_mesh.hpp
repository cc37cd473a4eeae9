#pragma once

#include "traces/gltf/clean/glb_builder.hpp"

namespace vestige {

/// Adds the material in which colliders are drawn. Returns its index.
int add_collider_material(gltf::GlbBuilder& builder);

/// Adds a sphere with this radius. Returns the index of the mesh.
int add_sphere(gltf::GlbBuilder& builder, double radius_m, int material);

}  // namespace vestige
