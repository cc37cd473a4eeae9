// Linear blend skinning, HAVE 2010 §III.A, in the order of detector/CONTRACT.md, 3. `precise` keeps the compiler from
// contracting or reordering it.

layout(location = VESTIGE_ATTRIBUTE_POSITION) in vec3 position_bind;
layout(location = VESTIGE_ATTRIBUTE_TEXTURE_COORDINATE) in vec2 texture_coordinate;
layout(location = VESTIGE_ATTRIBUTE_PALETTE_0) in uvec4 palette_0;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_0) in vec4 weight_0;
#if INFLUENCES > 4
layout(location = VESTIGE_ATTRIBUTE_PALETTE_1) in uvec4 palette_1;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_1) in vec4 weight_1;
#endif

layout(std430, binding = VESTIGE_BINDING_PALETTE) readonly buffer Palette {
  mat4 palette[];
};

out Skinned {
  vec3 position;
  vec2 texture_coordinate;
  flat int instance;
} skinned;

void main() {
  precise mat4 blend = mat4(0.0);
  for (int i = 0; i < min(INFLUENCES, 4); ++i) blend += weight_0[i] * palette[palette_0[i]];
#if INFLUENCES > 4
  for (int i = 0; i < INFLUENCES - 4; ++i) blend += weight_1[i] * palette[palette_1[i]];
#endif
  precise vec4 world =
      ((blend[0] * position_bind.x + blend[1] * position_bind.y) + blend[2] * position_bind.z) + blend[3];
  skinned.position = world.xyz;
  skinned.texture_coordinate = texture_coordinate;
  skinned.instance = gl_InstanceID;
}
