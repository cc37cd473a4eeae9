// Tests one triangle against a block of segments. The shader only proves misses. It captures every pair that it cannot
// prove to miss, and the CPU decides it. Each proof holds for the vertices that the CPU computes, which are within
// `radius` of ours, and for exact arithmetic on them.
//
// The proof. Let X_i be the triangle's corners relative to the collider: three at t = 0, three at t = 1. At every time
// the corners relative to the collider lie in the convex hull of these six, and at a contact the origin does too. (For
// `static` and `carried`, segment against resting triangle, the hull is their Minkowski difference, and the converse
// holds too.) So any axis m on which all six lie on one side of 0 proves a miss: the separating axis theorem. The axes
// are those that suffice for a segment and a triangle, and for both in one plane. An axis need not be accurate. It only
// has to be the same for all six, so its own rounding does not affect the proof. `precise` keeps a compiler from
// computing it, or anything that it is made of, in several ways. A sphere needs more: along m, all six must be farther
// from 0 than its radius.
//
// The bound. Let u = 2^-24 (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 3.1). A coordinate of X_i
// is the difference of a vertex and an end of the segment. It lies within radius + u |X_i| of the true one. m . X_i, in
// any order and with fma or without, errs by at most gamma_3 |m| . |X_i|. So R_i = radius + 8 u |X_i| and m . X_i >
// 1.001 |m| . R_i + kTiny prove m . X_i > 0. The factor covers the rounding of the right side, and kTiny covers flushed
// denormals. To flush an operand or a result below 2^-126 errs by less than 2^-126 times the other factors. If X_i is
// flushed, `radius`, which is never less than 2^-116, covers it. Elsewhere the other factors are at most kLargest,
// 2^26, and 64 such errors are less than 2^-94. Within kLargest nothing overflows. Beyond it the shader captures the
// pair.

layout(triangles) in;
layout(points, max_vertices = 1) out;

in Skinned {
  vec3 position;
  vec3 radius;
#if METHOD != VESTIGE_METHOD_STATIC
  vec3 position_before;
  vec3 radius_before;
#endif
} skinned[];

struct GpuSegment {
  vec4 low;  // corners of its box
  vec4 high;
  vec4 start;  // w: the radius of a sphere, 2^-20 larger than it is; 0 for a point
  vec4 end;
};
layout(std140, binding = VESTIGE_BINDING_SEGMENTS) uniform Segments {
  GpuSegment segments[BLOCK_SEGMENTS];
};
layout(std430, binding = VESTIGE_BINDING_CAPTURED) buffer Captured {
  uint captured_count;  // continues to count if there is no room
  uint capacity;        // number of pairs that fit
  uvec2 captured[];     // number of the segment, number of the triangle
};

layout(location = VESTIGE_UNIFORM_SEGMENT_COUNT) uniform int segment_count;  // in this block
layout(location = VESTIGE_UNIFORM_FIRST_SEGMENT) uniform int first_segment;
layout(location = VESTIGE_UNIFORM_FIRST_TRIANGLE) uniform int first_triangle;

const float kLargest = 67108864.0;
const float kSlack = 1.001;
const float kTiny = 1.0 / 1237940039285380274899124224.0;  // 2^-90
const float kLost = 1.0 / 288230376151711744.0;  // 2^-58: more than the length of a vector whose squares are flushed
const float kFourUlps = 1.0 / 2097152.0;                      // 8 u

const float kThird = 1.0 / 3.0;

float radius;  // of the sphere, or 0
precise vec3 relative[6];
vec3 relative_radius[6];
#if METHOD == VESTIGE_METHOD_CCD
float together;  // error of a determinant if two or three corners move
#endif

#if METHOD == VESTIGE_METHOD_CARRIED
precise vec3 carried;  // the mean displacement, which moves the segment's start
vec3 carried_radius;   // largest distance from the true displacement
#endif

// Returns whether all corners are proven to lie on one side of the origin along the axis a x b, and farther away than the
// radius.
bool apart_along_cross(vec3 a, vec3 b) {
  precise vec3 axis = cross(a, b);
  vec3 magnitude = abs(axis);
  float reach = radius > 0.0 ? kSlack * radius * (length(axis) + kLost) : 0.0;
  bool above = true;
  bool below = true;
  for (int i = 0; i < 6; ++i) {
    precise float along = dot(axis, relative[i]);
    float error = kSlack * dot(magnitude, relative_radius[i]) + kTiny + reach;
    above = above && along > error;
    below = below && -along > error;
  }
  return above || below;
}

void set_relative(int i, vec3 vertex, vec3 vertex_radius, vec3 end, vec3 end_radius) {
  relative[i] = vertex - end;
  relative_radius[i] = vertex_radius + end_radius + kFourUlps * abs(relative[i]);
}

#if METHOD == VESTIGE_METHOD_CCD
// Adds the determinant of three of the X_i, and its largest distance from the determinant of the true ones. To move
// each X within R changes the determinant by no more than the R . |cross product| of the other two, plus the effect of
// two or three moves together, 18 e^2 m + 6 e^3, with e the largest R and m the largest |X|. Its own rounding is at
// most gamma_5 times the sum of the magnitudes of its six products. The rounding of the cross products is at most
// gamma_2 times the sum of theirs.
void add_determinant(int x, int y, int z, inout float sum, inout float error) {
  precise vec3 plus_yz = relative[y].yzx * relative[z].zxy;
  precise vec3 minus_yz = relative[y].zxy * relative[z].yzx;
  vec3 size_yz = abs(plus_yz) + abs(minus_yz);
  precise vec3 cross_yz = plus_yz - minus_yz;
  vec3 x_size = abs(relative[x]);
  vec3 y_size = abs(relative[y]);
  vec3 z_size = abs(relative[z]);
  vec3 cross_zx = abs(cross(relative[z], relative[x])) + kFourUlps * (z_size.yzx * x_size.zxy + z_size.zxy * x_size.yzx);
  vec3 cross_xy = abs(cross(relative[x], relative[y])) + kFourUlps * (x_size.yzx * y_size.zxy + x_size.zxy * y_size.yzx);
  precise float determinant = dot(relative[x], cross_yz);
  sum += determinant;
  error += kSlack * (dot(relative_radius[x], abs(cross_yz) + kFourUlps * size_yz) +
                     dot(relative_radius[y], cross_zx) + dot(relative_radius[z], cross_xy) +
                     together + kFourUlps * dot(x_size, size_yz));
}

// Returns whether the three corners and the collider are proven never to lie in one plane. The cubic det(A(t), B(t),
// C(t)) has no root in [0, 1] if its four Bernstein coefficients have one sign. Each coefficient is, times 1 or 3, a
// sum of determinants of corners at t = 0 (numbers 0 to 2) and at t = 1 (3 to 5).
bool never_in_one_plane() {
  float e = 0.0;
  float m = 0.0;
  for (int i = 0; i < 6; ++i) {
    e = max(e, max(relative_radius[i].x, max(relative_radius[i].y, relative_radius[i].z)));
    m = max(m, max(abs(relative[i].x), max(abs(relative[i].y), abs(relative[i].z))));
  }
  together = 18.0 * e * e * m + 6.0 * e * e * e;
  bool above = true;
  bool below = true;
  for (int coefficient = 0; coefficient < 4; ++coefficient) {
    float sum = 0.0;
    float error = kTiny;
    for (int late = 0; late < 8; ++late) {  // bit i: corner i at t = 1
      if (bitCount(late) != coefficient) continue;
      add_determinant(3 * (late & 1), 1 + 3 * ((late >> 1) & 1), 2 + 3 * (late >> 2), sum, error);
    }
    above = above && sum > error;
    below = below && -sum > error;
  }
  return above || below;
}
#endif

bool proven_apart(vec3 segment_start, vec3 end) {
  precise vec3 start = segment_start;
  vec3 start_radius = vec3(0.0);
#if METHOD == VESTIGE_METHOD_CARRIED
  start += carried;
  start_radius = carried_radius + kFourUlps * abs(start);  // rounded here, and rounded to fp32 by the CPU
#endif
  for (int i = 0; i < 3; ++i) {
#if METHOD == VESTIGE_METHOD_CCD
    set_relative(i, skinned[i].position_before, skinned[i].radius_before, start, start_radius);
#else
    set_relative(i, skinned[i].position, skinned[i].radius, start, start_radius);
#endif
    set_relative(i + 3, skinned[i].position, skinned[i].radius, end, vec3(0.0));
  }
  vec3 largest = vec3(0.0);
  for (int i = 0; i < 6; ++i) largest = max(largest, max(abs(relative[i]), relative_radius[i]));
  if (!(largest.x <= kLargest && largest.y <= kLargest && largest.z <= kLargest)) return false;

  precise vec3 ab = relative[4] - relative[3];
  precise vec3 bc = relative[5] - relative[4];
  precise vec3 ca = relative[3] - relative[5];
  precise vec3 normal = cross(ab, ca);
  precise vec3 way = (relative[3] - relative[0]) + (relative[4] - relative[1]) + (relative[5] - relative[2]);
  return apart_along_cross(ab, ca) || apart_along_cross(way, ab) || apart_along_cross(way, bc) ||
         apart_along_cross(way, ca) || apart_along_cross(normal, ab) || apart_along_cross(normal, bc) ||
         apart_along_cross(normal, ca) || apart_along_cross(normal, way)
#if METHOD == VESTIGE_METHOD_CCD
         || (radius == 0.0 && never_in_one_plane())
#endif
      ;
}

void capture(int segment) {
  uint place = atomicAdd(captured_count, 1u);
  if (place < capacity) captured[place] = uvec2(first_segment + segment, first_triangle + gl_PrimitiveIDIn);
}

void main() {
  // A box around everything that the triangle covers. The margin includes the rounding of the box, u |corner|.
  precise vec3 low = vec3(3.402823466e38);
  precise vec3 high = -low;
  for (int i = 0; i < 3; ++i) {
    vec3 margin = kSlack * skinned[i].radius + kFourUlps * abs(skinned[i].position);
    low = min(low, skinned[i].position - margin);
    high = max(high, skinned[i].position + margin);
#if METHOD == VESTIGE_METHOD_CCD
    vec3 margin_before = kSlack * skinned[i].radius_before + kFourUlps * abs(skinned[i].position_before);
    low = min(low, skinned[i].position_before - margin_before);
    high = max(high, skinned[i].position_before + margin_before);
#endif
  }
#if METHOD == VESTIGE_METHOD_CARRIED
  // This must stay the sum of differences, whose error their own size bounds, and not become the difference of sums.
  precise vec3 moved = vec3(0.0);
  vec3 moved_radius = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    precise vec3 displacement = skinned[i].position - skinned[i].position_before;
    moved += displacement;
    moved_radius += skinned[i].radius + skinned[i].radius_before + kFourUlps * abs(displacement);
  }
  carried = kThird * moved;
  carried_radius = kSlack * kThird * moved_radius;
  // The box moves in the opposite direction of the start.
  vec3 margin_carried = carried_radius + kFourUlps * abs(carried);
  low -= max(carried, vec3(0.0)) + margin_carried + kFourUlps * abs(low);
  high += max(-carried, vec3(0.0)) + margin_carried + kFourUlps * abs(high);
#endif

  // Two steps, 32 segments at a time. A processor that runs many triangles in lockstep pays for the work of any of
  // them. So it pays for the second step only as often as one triangle has segments close by.
  for (int first = 0; first < segment_count; first += 32) {
    int count = min(segment_count - first, 32);
    uint close = 0u;
    for (int i = 0; i < count; ++i) {
      bool apart = any(greaterThan(low, segments[first + i].high.xyz)) ||
                   any(lessThan(high, segments[first + i].low.xyz));
      if (!apart) close |= 1u << i;
    }
    while (close != 0u) {
      int segment = first + findLSB(close);
      close &= close - 1u;
      radius = segments[segment].start.w;
      if (!proven_apart(segments[segment].start.xyz, segments[segment].end.xyz)) capture(segment);
    }
  }
}
