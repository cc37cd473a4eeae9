// Linear blend skinning in the order of detector/CONTRACT.md, 3, and, for each coordinate, the largest distance between
// the result and the vertex that the CPU computes.
//
// The bound. Let u = 2^-24. By the standard model (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 2.2
// and 3.1) every rounded operation errs by at most u times its result. A sum of products errs by at most u times the
// sum of the magnitudes of all partial results. An fma only removes roundings. With n influences of weight w and
// matrices M, on a bind position x:
//   blending      errs by n u S,  S = sum of |w| (|M_0 x| + |M_1 y| + |M_2 z| + |M_3|): 1 product, n - 1 sums. Padding
//                 influences add exact zeros; one influence of weight 1 errs by nothing.
//   its products  by x, y and z err by u (|b_0 x| + |b_1 y| + |b_2 z|), at most u (S - |b_3|)
//   their sums    err by u (|s_1| + |s_2| + |position|), the three partial sums
// The CPU errs by as much, so twice that bounds the difference. The omitted terms are of relative size 100 u (powers of
// u, the rounding of the bound itself, the CPU's partial sums in place of ours). kTwoRoundings is larger by 2^-10 to
// cover them. Flushed denormals err absolutely, and least_radius covers them (`least_radius_m` in
// geometry_detector.cpp).
// `precise` forbids reordering. The proof does not rely on it to forbid fma too.

layout(location = VESTIGE_ATTRIBUTE_POSITION) in vec3 position_bind;
layout(location = VESTIGE_ATTRIBUTE_PALETTE_0) in uvec4 palette_0;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_0) in vec4 weight_0;
#if INFLUENCES > 4
layout(location = VESTIGE_ATTRIBUTE_PALETTE_1) in uvec4 palette_1;
layout(location = VESTIGE_ATTRIBUTE_WEIGHT_1) in vec4 weight_1;
#endif

// A uniform block if the palette fits into one, because drivers read it faster. A mat4x3 is four columns of 16 bytes
// either way.
#if PALETTE_ENTRIES > 0
layout(std140, binding = VESTIGE_BINDING_PALETTE) uniform Palette {
  mat4x3 palette[PALETTE_ENTRIES];
};
#else
layout(std430, binding = VESTIGE_BINDING_PALETTE) readonly buffer Palette {
  mat4x3 palette[];
};
#endif

layout(location = VESTIGE_UNIFORM_PALETTE_SIZE) uniform uint palette_size;
layout(location = VESTIGE_UNIFORM_LEAST_RADIUS) uniform float least_radius;

out Skinned {
  vec3 position;
  vec3 radius;
#if METHOD != VESTIGE_METHOD_STATIC
  vec3 position_before;
  vec3 radius_before;
#endif
} skinned;

const float kTwoRoundings = 1.001 / 8388608.0;  // 2 u

precise mat4x3 blend;
mat4x3 size;      // the same sum of magnitudes
float roundings;  // roundings of blending

void add_influence(float weight, uint entry) {
  mat4x3 matrix = palette[entry];
  blend += weight * matrix;
  float magnitude = abs(weight);
  for (int c = 0; c < 4; ++c) size[c] += magnitude * abs(matrix[c]);
  if (weight != 0.0) roundings += 1.0;
}

void skin(uint first_entry, out vec3 position, out vec3 radius) {
  blend = mat4x3(0.0);
  size = mat4x3(0.0);
  roundings = 0.0;
  for (int i = 0; i < min(INFLUENCES, 4); ++i) add_influence(weight_0[i], first_entry + palette_0[i]);
#if INFLUENCES > 4
  for (int i = 0; i < INFLUENCES - 4; ++i) add_influence(weight_1[i], first_entry + palette_1[i]);
#endif
  if (roundings == 1.0 && weight_0[0] == 1.0) roundings = 0.0;

  precise vec3 sum_1 = blend[0] * position_bind.x + blend[1] * position_bind.y;
  precise vec3 sum_2 = sum_1 + blend[2] * position_bind.z;
  precise vec3 world = sum_2 + blend[3];
  vec3 extent = abs(position_bind);
  vec3 products = size[0] * extent.x + size[1] * extent.y + size[2] * extent.z;
  position = world;
  radius = kTwoRoundings * (roundings * (products + size[3]) + products + abs(sum_1) + abs(sum_2) + abs(world)) +
           least_radius;
}

void main() {
  skin(0u, skinned.position, skinned.radius);
#if METHOD != VESTIGE_METHOD_STATIC
  skin(palette_size, skinned.position_before, skinned.radius_before);
#endif
}
