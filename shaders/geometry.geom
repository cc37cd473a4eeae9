// One triangle against a block of segments. It only proves misses: every pair that it cannot prove to miss is captured,
// for the CPU to decide. Whatever it proves holds for the vertices that the CPU computes, within `radius` of ours, and
// for exact arithmetic on them.
//
// The proof. Let X_i be the triangle's corners relative to the collider: three at t = 0, three at t = 1. At every time
// the corners relative to the collider lie in the convex hull of these six, and at a contact so does the origin (for
// `static` and `carried`, segment against resting triangle, the hull is their Minkowski difference, and then it holds
// both ways). So any axis m on which all six lie on one side of 0 proves a miss: the separating axis theorem. The axes
// are those that suffice for a segment and a triangle, and for both in one plane. An axis need not be accurate: it only
// has to be the same for all six, so its own rounding harms no proof.
//
// The bound, u = 2^-24 (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 3.1): a coordinate of X_i, the
// difference of a vertex and an end of the segment, lies within radius + u |X_i| of the true one; m . X_i, in whatever
// order and with fma or without, errs by at most gamma_3 |m| . |X_i|. So R_i = radius + 8 u |X_i| and m . X_i > 1.001
// |m| . R_i + kTiny prove m . X_i > 0; the factor covers the rounding of the right side, kTiny what flushed denormals
// do: with |X_i| <= kLargest, 2^26, every component of an axis is below 2^83, and a dozen operations that flush operands
// or results below 2^-126 err by less than 2^-126 (12 + 3 |X_i|) < 2^-96 beside what `radius`, never less than 2^-116,
// covers. Within kLargest nothing overflows; beyond it, and where something is NaN, the pair is captured.

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
  vec4 start;
  vec4 end;
};
layout(std140, binding = VESTIGE_BINDING_SEGMENTS) uniform Segments {
  GpuSegment segments[BLOCK_SEGMENTS];
};
layout(std430, binding = VESTIGE_BINDING_CAPTURED) buffer Captured {
  uint captured_count;  // counts on where there is no room
  uint unused;
  uvec2 captured[];  // number of the segment, number of the triangle
};

layout(location = VESTIGE_UNIFORM_SEGMENT_COUNT) uniform int segment_count;  // in this block
layout(location = VESTIGE_UNIFORM_FIRST_SEGMENT) uniform int first_segment;
layout(location = VESTIGE_UNIFORM_CAPACITY) uniform uint capacity;

const float kLargest = 67108864.0;
const float kSlack = 1.001;
const float kTiny = 1.0 / 79228162514264337593543950336.0;  // 2^-96
const float kFourUlps = 1.0 / 2097152.0;                      // 8 u

const float kThird = 1.0 / 3.0;

precise vec3 relative[6];
vec3 relative_radius[6];

#if METHOD == VESTIGE_METHOD_CARRIED
vec3 carried;         // the mean displacement, which moves the segment's start
vec3 carried_radius;  // how far it may lie from the true one
#endif

// Whether all corners are proven to lie on one side of the origin along `axis`.
bool apart_along(vec3 axis) {
  vec3 magnitude = abs(axis);
  bool above = true;
  bool below = true;
  for (int i = 0; i < 6; ++i) {
    precise float along = dot(axis, relative[i]);
    float error = kSlack * dot(magnitude, relative_radius[i]) + kTiny;
    above = above && along > error;
    below = below && -along > error;
  }
  return above || below;
}

void set_relative(int i, vec3 vertex, vec3 vertex_radius, vec3 end, vec3 end_radius) {
  relative[i] = vertex - end;
  relative_radius[i] = vertex_radius + end_radius + kFourUlps * abs(relative[i]);
}

bool proven_apart(vec3 start, vec3 end) {
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
  for (int i = 0; i < 6; ++i) largest = max(largest, abs(relative[i]));
  if (!(largest.x <= kLargest && largest.y <= kLargest && largest.z <= kLargest)) return false;

  vec3 ab = relative[4] - relative[3];
  vec3 bc = relative[5] - relative[4];
  vec3 ca = relative[3] - relative[5];
  vec3 normal = cross(ab, ca);
  vec3 way = (relative[3] - relative[0]) + (relative[4] - relative[1]) + (relative[5] - relative[2]);
  return apart_along(normal) || apart_along(cross(way, ab)) || apart_along(cross(way, bc)) ||
         apart_along(cross(way, ca)) || apart_along(cross(normal, ab)) || apart_along(cross(normal, bc)) ||
         apart_along(cross(normal, ca)) || apart_along(cross(normal, way));
}

void capture(int segment) {
  uint place = atomicAdd(captured_count, 1u);
  if (place < capacity) captured[place] = uvec2(first_segment + segment, gl_PrimitiveIDIn);
}

void main() {
  // A box around all that the triangle covers; its own rounding, u |corner|, is in the margin.
  vec3 low = vec3(3.402823466e38);
  vec3 high = -low;
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
  vec3 moved = vec3(0.0);
  vec3 moved_radius = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    vec3 displacement = skinned[i].position - skinned[i].position_before;
    moved += displacement;
    moved_radius += skinned[i].radius + skinned[i].radius_before + kFourUlps * abs(displacement);
  }
  carried = kThird * moved;
  carried_radius = kSlack * kThird * moved_radius;
  // Where the start goes, the box goes the other way.
  vec3 margin_carried = carried_radius + kFourUlps * abs(carried);
  low -= max(carried, vec3(0.0)) + margin_carried + kFourUlps * abs(low);
  high += max(-carried, vec3(0.0)) + margin_carried + kFourUlps * abs(high);
#endif

  // In two steps, 32 segments at a time: a processor that runs many triangles in step pays for whatever any of them
  // does, and so for the second step only as often as one triangle has segments close by.
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
      if (!proven_apart(segments[segment].start.xyz, segments[segment].end.xyz)) capture(segment);
    }
  }
}
