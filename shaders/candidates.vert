// Bounds one triangle of a touched meshlet. The CPU skinned the corners, to the bits that it will decide on. The bounds
// are a box that contains the triangle within the frame and, except for `static`, two slabs along its normal: one at
// the frame's start, where a segment starts, and one at its end. A segment that misses the box, or whose ends are on
// the same side of both slabs, surely misses the triangle.
//
// Boxes. Those of `static` and `ccd` are not rounded, and denormals flushed to zero keep their order. For `carried`,
// the displacement m moves a start, which is then rounded to fp32. The moved start is at or above `low` only if the
// start was at or above low - m. Let M be the largest magnitude of the corners' coordinates, and u = 2^-24. m is
// computed here in fp32, in any order, and errs by less than 20 u M (differences of at most 2 M, their sums, a third).
// Near the box, rounding the moved start errs by at most 2 u M. The subtractions here err by 6 u M. The margin is 64 u
// M.
//
// Slabs. Take any axis n, and the segment's ends relative to the triangle's corners at the time of each end. If all lie
// on one side along n, the segment misses the triangle (shaders/geometry.geom). n need not be accurate, but it must be
// the same for all. n . x errs by at most 4 u |n| . |x|, with fma or without (Higham, Accuracy and Stability of
// Numerical Algorithms, 2nd ed., 3.1). For `carried`, n . (x + m) of the start is compared as n . x with a slab moved
// by -n . m. Four errors add up: those of m above; that of the product, 6 u |n| . M; that of the subtraction, 3 u |n| .
// M; and that of rounding the start, u |n| . (|x| + 2 M). Together that is less than 48 u |n| . M on the slab's side,
// and 8 u |n| . |x| on the segment's side. Each side gets 64 u, which also covers its own rounding.
//
// Flushed denormals. A coordinate, or a term of m, errs by less than 2^-126 each time, fewer than 64 times. M is taken
// as at least 2^-90, so that 64 u M covers this. A flushed product, or a product with a flushed factor, errs by less
// than 2^-126 times the other factor. That factor is at most kLargest for a coordinate, or the product belongs to the
// margin itself. kTiny is larger than this error. Within kLargest nothing overflows: n is below 2^56 and a product
// below 2^84. Beyond kLargest the shader proves nothing.

layout(location = VESTIGE_ATTRIBUTE_CORNERS) in vec3 corners[3];
#if METHOD != VESTIGE_METHOD_STATIC
layout(location = VESTIGE_ATTRIBUTE_CORNERS_BEFORE) in vec3 corners_before[3];
#endif

out Bounds {
  vec4 low;   // w: the slab at the frame's end
  vec4 high;
#if METHOD == VESTIGE_METHOD_STATIC
  vec3 a;  // 0, like b and c, if the bounds cannot be computed
  vec3 b;
  vec3 c;
#else
  vec3 normal;
  vec2 slab_start;
#endif
} bounds;

const float kInfinite = 3.402823466e38;
const float kLargest = 67108864.0;                          // 2^26
const float kLeast = 1.0 / 1237940039285380274899124224.0;  // 2^-90
const float kTiny = kLeast;
const float kMargin = 1.0 / 262144.0;  // 64 u
const float kThird = 1.0 / 3.0;

vec2 slab_of(vec3 normal, vec3 a, vec3 b, vec3 c) {
  float along_a = dot(normal, a);
  float along_b = dot(normal, b);
  float along_c = dot(normal, c);
  return vec2(min(min(along_a, along_b), along_c), max(max(along_a, along_b), along_c));
}

void main() {
  vec3 a = corners[0];
  vec3 b = corners[1];
  vec3 c = corners[2];
  vec3 low = min(min(a, b), c);
  vec3 high = max(max(a, b), c);
  vec3 largest = max(max(abs(low), abs(high)), vec3(kLeast));
#if METHOD == VESTIGE_METHOD_STATIC
  bool computable = max(largest.x, max(largest.y, largest.z)) <= kLargest;
  vec2 slab = vec2(0.0);
  bounds.a = computable ? a : vec3(0.0);
  bounds.b = computable ? b : vec3(0.0);
  bounds.c = computable ? c : vec3(0.0);
#else
  vec3 a_before = corners_before[0];
  vec3 b_before = corners_before[1];
  vec3 c_before = corners_before[2];
  vec3 low_before = min(min(a_before, b_before), c_before);
  vec3 high_before = max(max(a_before, b_before), c_before);
  largest = max(largest, max(abs(low_before), abs(high_before)));
  bool computable = max(largest.x, max(largest.y, largest.z)) <= kLargest;
  precise vec3 normal = cross(b - a, c - a);
  if (!computable) normal = vec3(0.0);

  float margin = kMargin * dot(abs(normal), largest) + kTiny;
  vec2 wider = vec2(-margin, margin);
  vec2 slab = slab_of(normal, a, b, c);
#if METHOD == VESTIGE_METHOD_CCD
  vec2 slab_start = slab_of(normal, a_before, b_before, c_before);
  low = min(low, low_before);
  high = max(high, high_before);
#else
  precise vec3 moved = ((a - a_before) + (b - b_before) + (c - c_before)) * kThird;
  vec2 slab_start = slab - dot(normal, moved);
  low -= max(moved, vec3(0.0)) + kMargin * largest;
  high += max(-moved, vec3(0.0)) + kMargin * largest;
#endif
  vec2 infinite = vec2(-kInfinite, kInfinite);
  slab = computable ? slab + wider : infinite;
  bounds.normal = normal;
  bounds.slab_start = computable ? slab_start + wider : infinite;
#endif

  bounds.low = vec4(computable ? low : vec3(-kInfinite), slab.x);
  bounds.high = vec4(computable ? high : vec3(kInfinite), slab.y);
}
