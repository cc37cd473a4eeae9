// The scene for people: the skinned avatar, or, with COLLIDERS, the colliders as points.

layout(location = VESTIGE_ATTRIBUTE_POSITION) in vec3 position_bind;
layout(location = VESTIGE_UNIFORM_WORLD_TO_CLIP) uniform mat4 world_to_clip;

out vec3 position_world;

#if COLLIDERS
void main() {
  position_world = position_bind;
  gl_Position = world_to_clip * vec4(position_bind, 1.0);
  gl_PointSize = 6.0;
}
#else
layout(location = VESTIGE_ATTRIBUTE_PALETTE_0) in uvec4 palette_0;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_0) in vec4 weight_0;
#if INFLUENCES > 4
layout(location = VESTIGE_ATTRIBUTE_PALETTE_1) in uvec4 palette_1;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_1) in vec4 weight_1;
#endif

layout(std430, binding = VESTIGE_BINDING_PALETTE) readonly buffer Palette {
  mat4 palette[];
};

void main() {
  mat4 blend = mat4(0.0);
  for (int i = 0; i < min(INFLUENCES, 4); ++i) blend += weight_0[i] * palette[palette_0[i]];
#if INFLUENCES > 4
  for (int i = 0; i < INFLUENCES - 4; ++i) blend += weight_1[i] * palette[palette_1[i]];
#endif
  position_world = (blend[0] * position_bind.x + blend[1] * position_bind.y + blend[2] * position_bind.z + blend[3]).xyz;
  gl_Position = world_to_clip * vec4(position_world, 1.0);
}
#endif
