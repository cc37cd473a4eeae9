// Tests one triangle of a touched meshlet against the segments that may meet this meshlet. The shader only proves
// misses, by the bounds of candidates.vert, which has the proof. It captures every other pair, and the CPU decides it.
//
// For `static` the bounds are a box and the signs of decide_static.cpp, relative to the segment's start. So almost
// every captured pair really meets. For the other methods the bounds are only boxes and slabs. llvmpipe runs the code
// of a branch or a loop at least once for all triangles. So testing all the axes of geometry.geom would take most of
// the time there, and would save the CPU two decisions of three.

layout(points) in;
layout(points, max_vertices = 1) out;

in Bounds {
  vec4 low;   // w: the slab at the frame's end
  vec4 high;
#if METHOD == VESTIGE_METHOD_STATIC
  vec3 a;
  vec3 b;
  vec3 c;
#else
  vec3 normal;
  vec2 slab_start;
#endif
} bounds[];

// A meshlet, or a part of its segments.
struct Slot {
  uint first;    // index of its first segment in this block
  uint count;    // at least one
  uint touched;  // number of the touched meshlet
  uint offset;   // number of its first segment among the meshlet's segments
};
struct GpuSegment {
  vec4 start;  // w: the radius of a sphere, 2^-20 larger than it is; 0 for a point
  vec4 end;
};
layout(std140, binding = VESTIGE_BINDING_CANDIDATES) uniform Candidates {
  Slot slots[BLOCK_SLOTS];
  GpuSegment segments[BLOCK_SEGMENTS];
};
layout(std430, binding = VESTIGE_BINDING_CAPTURED) buffer Captured {
  uint captured_count;  // continues to count if there is no room
  uint capacity;        // number of pairs that fit
  uvec2 captured[];     // number of the segment among the meshlet's segments, MESHLET_TRIANGLES * touched + triangle
};

const float kLargest = 67108864.0;                        // 2^26
const float kTiny = 1.0 / 1237940039285380274899124224.0;  // 2^-90
const float kMargin = 1.0 / 262144.0;                      // 64 u
const float kSlack = 1.001;
const float kLost = 1.0 / 288230376151711744.0;  // 2^-58: more than the length of a vector whose squares are flushed

#if METHOD == VESTIGE_METHOD_STATIC
const float kVolumeError = 96.0 / 16777216.0;            // 96 u
const float kTinyVolume = 1.0 / 1152921504606846976.0;  // 2^-60

float largest(vec3 v) {
  return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

bool one_sign(float x, float x_error, float y, float y_error) {
  return (x > x_error && y > y_error) || (-x > x_error && -y > y_error);
}

// All volumes are relative to the way's start. The way spans three volumes with the triangle's edges; two of opposite
// signs prove a miss. The volume of the triangle itself is the height of the start. The way reduces this height by the
// sum of the other volumes. If the heights of both ends have one sign, it is a miss. Error bound: a volume has 6 terms,
// each at most the product of the largest coordinates. Each term meets 8 roundings (detector/decide/bounded.hpp), fewer
// with fma. Twice that covers the rounding of the bound itself and of the sums of volumes. Flushed denormals err by
// less than 2^-126 times two factors of at most 2^27, fewer than 64 times.
//
// A sphere misses if both ends are on one side of the plane and farther away than its radius: heights are distances times
// the length of the normal.
bool proven_beside(vec3 start, vec3 end, float radius) {
  precise vec3 way = end - start;
  precise vec3 a = bounds[0].a - start;
  precise vec3 b = bounds[0].b - start;
  precise vec3 c = bounds[0].c - start;
  vec3 normal_bc = cross(b, c);
  vec3 volumes = vec3(dot(way, cross(a, b)), dot(way, normal_bc), dot(way, cross(c, a)));
  float reach = max(largest(a), max(largest(b), largest(c)));
  float error = kVolumeError * largest(way) * reach * reach + kTinyVolume;
  float height = dot(a, normal_bc);
  float height_error = kVolumeError * reach * reach * reach + kTinyVolume;
  float height_end = height - (volumes.x + volumes.y + volumes.z);
  if (radius > 0.0) {
    float normal_length = kSlack * length(cross(b - a, c - a)) + kVolumeError * reach * reach + kLost;
    float far = height_error + kSlack * radius * normal_length;
    return one_sign(height, far, height_end, far + 3.0 * error);
  }
  return (any(greaterThan(volumes, vec3(error))) && any(lessThan(volumes, vec3(-error)))) ||
         one_sign(height, height_error, height_end, height_error + 3.0 * error);
}
#else
// A sphere misses if both ends are farther from the slabs than its radius.
bool proven_beside(vec3 start, vec3 end, float radius) {
  vec3 size = max(abs(start), abs(end));
  float margin = kMargin * dot(abs(bounds[0].normal), size) + kTiny;
  if (radius > 0.0) margin += kSlack * radius * (length(bounds[0].normal) + kLost);
  float along_start = dot(bounds[0].normal, start);
  float along_end = dot(bounds[0].normal, end);
  vec2 slab_start = bounds[0].slab_start;
  vec2 slab_end = vec2(bounds[0].low.w, bounds[0].high.w);
  return (along_start - margin > slab_start.y && along_end - margin > slab_end.y) ||
         (along_start + margin < slab_start.x && along_end + margin < slab_end.x);
}
#endif

bool proven_apart(vec3 start, vec3 end, float radius) {
  vec3 size = max(abs(start), abs(end));
  vec3 reach = radius > 0.0 ? radius + kMargin * (radius + size) : vec3(0.0);
  bool apart = any(greaterThan(bounds[0].low.xyz, max(start, end) + reach)) ||
               any(lessThan(bounds[0].high.xyz, min(start, end) - reach));
  bool computable = max(size.x, max(size.y, size.z)) <= kLargest;
  return apart || (computable && proven_beside(start, end, radius));
}

void main() {
  Slot slot = slots[gl_PrimitiveIDIn / MESHLET_TRIANGLES];
  uint triangle = MESHLET_TRIANGLES * slot.touched + uint(gl_PrimitiveIDIn % MESHLET_TRIANGLES);
  uint i = 0u;
  do {
    GpuSegment segment = segments[slot.first + i];
    if (!proven_apart(segment.start.xyz, segment.end.xyz, segment.start.w)) {
      uint place = atomicAdd(captured_count, 1u);
      if (place < capacity) captured[place] = uvec2(slot.offset + i, triangle);
    }
  } while (++i < slot.count);
}
