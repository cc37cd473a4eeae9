// Tests four triangles of a touched meshlet at once against the segments that may meet this meshlet: the stage that
// includes this text calls `test_triangles` for each of a slot's eight lanes. The CPU skinned the corners, to the bits
// that it will decide on, or cull.comp did (CULLED_ON_GPU), within `corner_error` of those. The shader only proves
// misses. Every other pair gets a bit in the lane's word, and the CPU decides it.
//
// The bounds of a triangle are a box that contains it within the frame and, except for `static`, two slabs along its
// normal: one at the frame's start, where a segment starts, and one at its end. A segment that misses the box, or whose
// ends are on the same side of both slabs, surely misses the triangle. For `static` the signs of decide_static.cpp,
// relative to the segment's start, take the place of the slabs, so almost every pair with a bit really meets.
//
// Each proof is a number that is above 0 if it holds: x - y > 0 holds only if x > y, with denormals or without.
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
// Volumes, for `static`. All are relative to the way's start. The way spans three volumes with the triangle's edges;
// two of opposite signs prove a miss. The volume of the triangle itself is the height of the start. The way reduces
// this height by the sum of the other volumes. If the heights of both ends have one sign, it is a miss. Error bound: a
// volume has 6 terms, each at most the product of the largest coordinates. Each term meets 8 roundings
// (detector/decide/bounded.hpp), fewer with fma. Twice that covers the rounding of the bound itself and of the sums of
// volumes. Flushed denormals err by less than 2^-126 times two factors of at most 2^27, fewer than 64 times.
//
// A sphere misses if both ends are on one side of the plane, or of the slabs, and farther away than its radius. Heights
// are distances times the length of the normal.
//
// Skinned by cull.comp. Let E be `corner_error`, which bounds the error of each coordinate, and for `carried` also that
// of a corner and m together (detector/proofs/gpu_culler.cpp). A box grows by E, and a slab by E |n|: its axis is
// the same for all. For the volumes with the way let r be the largest coordinate of the box that has grown. A product of
// two corners' coordinates errs by 2 E r. Six of them, times the way's, err by 12 E r; the margin is 16 E r. The height,
// a product of three corners, would err by far more. A slab along the normal takes its place, at rest, relative to the
// start: n . x of the corners and of the way err by at most 16 u |n| . (|x| + |way|) here, and the margin is 64 u.
//
// Flushed denormals. A coordinate, or a term of m, errs by less than 2^-126 each time, fewer than 64 times. M is taken
// as at least 2^-90, so that 64 u M covers this. A flushed product, or a product with a flushed factor, errs by less
// than 2^-126 times the other factor. That factor is at most kLargest for a coordinate, or the product belongs to the
// margin itself. kTiny is larger than this error. Within kLargest nothing overflows: n is below 2^56 and a product
// below 2^84. Beyond kLargest only the box proves something for a segment, and nothing for a triangle.

struct GpuSegment {
  vec4 start;  // w: the radius of a sphere, 2^-20 larger than it is; 0 for a point
  vec4 end;
};
// A meshlet, or a part of its segments.
#if CULLED_ON_GPU
struct Slot {
  uint meshlet;
  uint count;  // SLOT_SEGMENTS at most, at least one
  uint place;  // of the meshlet's corners
  uint segments[SLOT_SEGMENTS];  // their numbers in the frame
};
layout(std430, binding = VESTIGE_BINDING_CANDIDATES) buffer Slots {
  Slot slots[];
};
layout(std430, binding = VESTIGE_BINDING_SEGMENTS) readonly buffer Segments {
  GpuSegment segments[];
};
// What cull.comp did. It starts as zeros, apart from groups_y and groups_z.
layout(std430, binding = VESTIGE_BINDING_COUNTS) buffer Counts {
  uint groups_x;  // of the dispatch that proves
  uint groups_y;
  uint groups_z;
  uint slot_count;   // continues to count if there is no room
  uint place_count;  // likewise
  uint pairs;        // of a slot's meshlet and segment
  uint tested;       // pairs of any meshlet and segment
  uint corners_skinned;
};
layout(location = VESTIGE_UNIFORM_CORNER_ERROR) uniform float corner_error;
#else
struct Slot {
  uint first;  // index of its first segment in this block
  uint count;  // SLOT_SEGMENTS at most, at least one
  uint place;  // of the meshlet's corners
  uint unused;
};
layout(std140, binding = VESTIGE_BINDING_CANDIDATES) uniform Candidates {
  Slot slots[BLOCK_SLOTS];
  GpuSegment segments[BLOCK_SEGMENTS];
};
const float corner_error = 0.0;
#endif
// For each meshlet, now and, except for `static`, before: coordinate x, y, z of corner a, b, c of all triangles.
layout(binding = VESTIGE_TEXTURE_CORNERS) uniform samplerBuffer corners;
#if !ONLY_CULLS
// For each slot and lane: bits 4 i + j for segment i and triangle 4 lane + j, and, above them, 8 plus the number of
// segments that were tested. A word that does not say so was not completed.
layout(std430, binding = VESTIGE_BINDING_CAPTURED) writeonly buffer Words {
  uint words[];
};
layout(location = VESTIGE_UNIFORM_FIRST_SLOT) uniform uint first_slot;  // of this block, among the words
#endif

const float kLargest = 67108864.0;                          // 2^26
const float kLeast = 1.0 / 1237940039285380274899124224.0;  // 2^-90
const float kTiny = kLeast;
const float kMargin = 1.0 / 262144.0;  // 64 u
const float kThird = 1.0 / 3.0;
const float kSlack = 1.001;
const float kLost = 1.0 / 288230376151711744.0;  // 2^-58: more than the length of a vector whose squares are flushed
const float kVolumeError = 96.0 / 16777216.0;    // 96 u
const float kTinyVolume = 1.0 / 1152921504606846976.0;  // 2^-60

// A vector for each of four triangles.
struct Vectors {
  vec4 x;
  vec4 y;
  vec4 z;
};

vec4 dot4(Vectors a, Vectors b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
vec4 dot4(Vectors a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vectors cross4(Vectors a, Vectors b) {
  return Vectors(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
Vectors cross4(vec3 a, Vectors b) {
  return Vectors(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
Vectors minus(Vectors a, Vectors b) {
  return Vectors(a.x - b.x, a.y - b.y, a.z - b.z);
}
Vectors minus(Vectors a, vec3 b) {
  return Vectors(a.x - b.x, a.y - b.y, a.z - b.z);
}
Vectors abs4(Vectors a) {
  return Vectors(abs(a.x), abs(a.y), abs(a.z));
}
Vectors min4(Vectors a, Vectors b) {
  return Vectors(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z));
}
Vectors max4(Vectors a, Vectors b) {
  return Vectors(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z));
}
vec4 largest_of(Vectors a) {
  return max(a.x, max(a.y, a.z));
}
float largest_of(vec3 a) {
  return max(a.x, max(a.y, a.z));
}

struct Triangles {
  Vectors a;
  Vectors b;
  Vectors c;
};

struct Bounds {
  Vectors low;
  Vectors high;
  bvec4 computable;
#if METHOD == VESTIGE_METHOD_STATIC
  Triangles corners;
#else
  Vectors normal;
  vec4 normal_length;
  vec4 start_low;  // the slab at the frame's start
  vec4 start_high;
  vec4 end_low;
  vec4 end_high;
#endif
};

Vectors fetch(int texel) {
  return Vectors(texelFetch(corners, texel), texelFetch(corners, texel + 24), texelFetch(corners, texel + 48));
}

// The corners of four triangles of the meshlet at this place.
Triangles fetch_triangles(uint place, uint lane) {
  int texel = int(place * 72u + lane);
  return Triangles(fetch(texel), fetch(texel + 8), fetch(texel + 16));
}

Vectors low_of(Triangles t) {
  return min4(t.a, min4(t.b, t.c));
}
Vectors high_of(Triangles t) {
  return max4(t.a, max4(t.b, t.c));
}
Vectors grown(Vectors ends, float by) {
  return Vectors(ends.x + by, ends.y + by, ends.z + by);
}

void slab_of(Vectors normal, Triangles t, out vec4 low, out vec4 high) {
  vec4 along_a = dot4(normal, t.a);
  vec4 along_b = dot4(normal, t.b);
  vec4 along_c = dot4(normal, t.c);
  low = min(along_a, min(along_b, along_c));
  high = max(along_a, max(along_b, along_c));
}

#if METHOD == VESTIGE_METHOD_STATIC
Bounds bounds_of(uint place, uint lane) {
  Bounds bounds;
  bounds.corners = fetch_triangles(place, lane);
  bounds.low = grown(low_of(bounds.corners), -corner_error);
  bounds.high = grown(high_of(bounds.corners), corner_error);
  bounds.computable = lessThanEqual(largest_of(max4(abs4(bounds.low), abs4(bounds.high))), vec4(kLargest));
  return bounds;
}

#if CULLED_ON_GPU
// Above 0 if both ends are on one side of the triangle, whose corners are relative to the start.
vec4 beside_plane(Triangles corners, vec3 way, vec4 reach, float radius) {
  precise Vectors normal = cross4(minus(corners.b, corners.a), minus(corners.c, corners.a));
  vec4 low;
  vec4 high;
  slab_of(normal, corners, low, high);
  vec4 along_way = dot4(normal, way);
  vec4 size = kMargin * (reach + largest_of(abs(way))) + corner_error;
  vec4 margin = dot4(abs4(normal), Vectors(size, size, size)) + kTiny;
#if SPHERES
  margin += kSlack * radius * (sqrt(dot4(normal, normal)) + kLost);
#endif
  return max(min(low, low - along_way), min(-high, along_way - high)) - margin;
}
#endif

vec4 beside(Bounds bounds, vec3 start, vec3 end, float radius) {
  precise vec3 way = end - start;
  precise Vectors a = minus(bounds.corners.a, start);
  precise Vectors b = minus(bounds.corners.b, start);
  precise Vectors c = minus(bounds.corners.c, start);
  Vectors way_a = cross4(way, a);
  vec4 volume_ab = dot4(way_a, b);
  Vectors normal_bc = cross4(b, c);
  vec4 volume_bc = dot4(normal_bc, way);
  vec4 volume_ca = -dot4(way_a, c);
  // The largest coordinate of a, b and c.
  vec4 reach = max(largest_of(minus(bounds.high, start)), -min(bounds.low.x - start.x, min(bounds.low.y - start.y, bounds.low.z - start.z)));
  vec4 reach_error = (kVolumeError * reach + 16.0 * corner_error) * reach;
  vec4 error = reach_error * largest_of(abs(way)) + kTinyVolume;
  vec4 signs = min(max(volume_ab, max(volume_bc, volume_ca)), -min(volume_ab, min(volume_bc, volume_ca))) - error;
#if SPHERES
  if (radius > 0.0) signs = vec4(-1.0);
#endif
#if CULLED_ON_GPU
  return max(signs, beside_plane(Triangles(a, b, c), way, reach, radius));
#else
  vec4 height = dot4(a, normal_bc);
  vec4 height_end = height - (volume_ab + volume_bc + volume_ca);
  vec4 far = reach_error * reach + kTinyVolume;
#if SPHERES
  Vectors normal = cross4(minus(b, a), minus(c, a));
  if (radius > 0.0) far += kSlack * radius * (kSlack * sqrt(dot4(normal, normal)) + reach_error + kLost);
#endif
  vec4 far_end = far + 3.0 * error;
  return max(signs, max(min(height - far, height_end - far_end), min(-height - far, -height_end - far_end)));
#endif
}
#else
Bounds bounds_of(uint place, uint lane) {
  Bounds bounds;
  Triangles now = fetch_triangles(2u * place, lane);
  Triangles before = fetch_triangles(2u * place + 1u, lane);
  Vectors low = low_of(now);
  Vectors high = high_of(now);
  Vectors low_before = low_of(before);
  Vectors high_before = high_of(before);
  Vectors least = Vectors(vec4(kLeast), vec4(kLeast), vec4(kLeast));
  Vectors largest = max4(max4(max4(abs4(low), abs4(high)), max4(abs4(low_before), abs4(high_before))), least);
  bounds.computable = lessThanEqual(largest_of(largest), vec4(kLargest));
  precise Vectors normal = cross4(minus(now.b, now.a), minus(now.c, now.a));
  bounds.normal = normal;
  bounds.normal_length = sqrt(dot4(normal, normal)) + kLost;
  Vectors error = Vectors(kMargin * largest.x + corner_error, kMargin * largest.y + corner_error, kMargin * largest.z + corner_error);
  slab_of(normal, now, bounds.end_low, bounds.end_high);
#if METHOD == VESTIGE_METHOD_CCD
  slab_of(normal, before, bounds.start_low, bounds.start_high);
  bounds.low = grown(min4(low, low_before), -corner_error);
  bounds.high = grown(max4(high, high_before), corner_error);
#else
  precise Vectors a = minus(now.a, before.a);
  precise Vectors b = minus(now.b, before.b);
  precise Vectors c = minus(now.c, before.c);
  precise Vectors moved = Vectors(((a.x + b.x) + c.x) * kThird, ((a.y + b.y) + c.y) * kThird, ((a.z + b.z) + c.z) * kThird);
  vec4 along = dot4(normal, moved);
  bounds.start_low = bounds.end_low - along;
  bounds.start_high = bounds.end_high - along;
  bounds.low = Vectors(low.x - (max(moved.x, 0.0) + error.x), low.y - (max(moved.y, 0.0) + error.y),
                       low.z - (max(moved.z, 0.0) + error.z));
  bounds.high = Vectors(high.x + (max(-moved.x, 0.0) + error.x), high.y + (max(-moved.y, 0.0) + error.y),
                        high.z + (max(-moved.z, 0.0) + error.z));
#endif
  vec4 margin = dot4(abs4(normal), error) + kTiny;
  bounds.start_low -= margin;
  bounds.start_high += margin;
  bounds.end_low -= margin;
  bounds.end_high += margin;
  return bounds;
}

vec4 beside(Bounds bounds, vec3 start, vec3 end, float radius) {
  vec3 size = max(abs(start), abs(end));
  vec4 margin = kMargin * dot4(abs4(bounds.normal), size) + kTiny;
#if SPHERES
  margin += kSlack * radius * bounds.normal_length;
#endif
  vec4 along_start = dot4(bounds.normal, start);
  vec4 along_end = dot4(bounds.normal, end);
  return max(min((along_start - margin) - bounds.start_high, (along_end - margin) - bounds.end_high),
             min(bounds.start_low - (along_start + margin), bounds.end_low - (along_end + margin)));
}
#endif

// Above 0 if the box proves a miss.
vec4 apart(Bounds bounds, vec3 low, vec3 high) {
  return max(max(max(bounds.low.x - high.x, bounds.low.y - high.y), max(bounds.low.z - high.z, low.x - bounds.high.x)),
             max(low.y - bounds.high.y, low.z - bounds.high.z));
}

// The box around everything that a collider covers.
void box_of(GpuSegment segment, out vec3 low, out vec3 high) {
  vec3 start = segment.start.xyz;
  vec3 end = segment.end.xyz;
  low = min(start, end);
  high = max(start, end);
#if SPHERES
  float radius = segment.start.w;
  if (radius > 0.0) {
    vec3 reach = radius + kMargin * (radius + max(abs(start), abs(end)));
    low -= reach;
    high += reach;
  }
#endif
}

// Returns 1 for each triangle that the segment may meet. A proof that is not a number proves nothing.
uvec4 may_meet(Bounds bounds, GpuSegment segment) {
  vec3 start = segment.start.xyz;
  vec3 end = segment.end.xyz;
  float radius = segment.start.w;
  vec3 size = max(abs(start), abs(end));
  vec3 low;
  vec3 high;
  box_of(segment, low, high);
  vec4 proof = apart(bounds, low, high);
  if (largest_of(size) <= kLargest) proof = max(proof, beside(bounds, start, end, radius));
  return uvec4(not(greaterThan(mix(vec4(-1.0), proof, bounds.computable), vec4(0.0))));
}

#if !ONLY_CULLS
// The index in `segments` of a slot's segment.
uint segment_index(uint slot, uint i) {
#if CULLED_ON_GPU
  return slots[slot].segments[i];
#else
  return slots[slot].first + i;
#endif
}

void test_triangles(uint number, uint lane) {
  uint count = slots[number].count;
  Bounds bounds = bounds_of(slots[number].place, lane);
  uvec4 bits = uvec4(0u);
  uint i = 0u;
  do {
    bits |= may_meet(bounds, segments[segment_index(number, i)]) << (4u * i);
  } while (++i < count);
  words[LANES * (first_slot + number) + lane] =
      bits.x | (bits.y << 1) | (bits.z << 2) | (bits.w << 3) | ((8u + i) << (4u * SLOT_SEGMENTS));
}
#endif
