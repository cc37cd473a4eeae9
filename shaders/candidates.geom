// One triangle of a touched meshlet against the segments that may meet this meshlet. It only proves misses, by the
// bounds of candidates.vert, where the proof is; every other pair is captured, for the CPU to decide.
//
// For `static` these are a box, a slab and the segment's side of each edge: hardly a pair is captured that does not meet.
// For the other methods no more than boxes and slabs, since llvmpipe runs whatever a branch or a loop holds at least
// once, for all triangles: all the axes of geometry.geom would take longest of all there, and spare the CPU two
// decisions of three.

layout(points) in;
layout(points, max_vertices = 1) out;

in Bounds {
  vec4 low;   // w: the slab at the end
  vec4 high;
  vec3 normal;
#if METHOD == VESTIGE_METHOD_STATIC
  vec3 a;
  vec3 b;
  vec3 c;
#else
  vec2 slab_start;
#endif
} bounds[];

// A meshlet, or a part of its segments.
struct Slot {
  uint first;    // of its segments in this block
  uint count;    // at least one
  uint touched;  // which of the touched meshlets it is
  uint offset;   // of its segments in that meshlet's
};
struct GpuSegment {
  vec4 start;
  vec4 end;
};
layout(std140, binding = VESTIGE_BINDING_CANDIDATES) uniform Candidates {
  Slot slots[BLOCK_SLOTS];
  GpuSegment segments[BLOCK_SEGMENTS];
};
layout(std430, binding = VESTIGE_BINDING_CAPTURED) buffer Captured {
  uint captured_count;  // counts on where there is no room
  uint capacity;        // pairs that there is room for
  uvec2 captured[];     // number of the segment among the meshlet's, MESHLET_TRIANGLES * touched + triangle
};

const float kLargest = 67108864.0;                        // 2^26
const float kTiny = 1.0 / 1237940039285380274899124224.0;  // 2^-90
const float kMargin = 1.0 / 262144.0;                      // 64 u

#if METHOD == VESTIGE_METHOD_STATIC
const float kSixteenUlps = 1.0 / 1048576.0;                // 16 u
const float kTinyVolume = 1.0 / 1152921504606846976.0;      // 2^-60

vec3 permanent(vec3 v, vec3 w) {
  return abs(v.yzx * w.zxy) + abs(v.zxy * w.yzx);
}

// The volumes that the way spans with the triangle's edges, as seen from its start: two of opposite signs prove a miss
// (detector/decide_static.cpp). In each term meet 8 roundings (detector/bounded.hpp), fewer with fma; 16 u times the sum
// of the terms' magnitudes covers its own rounding. Flushed denormals err by less than 2^-126 times two factors of at
// most 2^27, fewer than 64 times.
bool passes_beside(vec3 start, vec3 end) {
  precise vec3 way = end - start;
  precise vec3 a = bounds[0].a - start;
  precise vec3 b = bounds[0].b - start;
  precise vec3 c = bounds[0].c - start;
  vec3 volumes = vec3(dot(way, cross(a, b)), dot(way, cross(b, c)), dot(way, cross(c, a)));
  vec3 sizes = vec3(dot(abs(way), permanent(a, b)), dot(abs(way), permanent(b, c)), dot(abs(way), permanent(c, a)));
  vec3 errors = kSixteenUlps * sizes + kTinyVolume;
  return any(greaterThan(volumes, errors)) && any(lessThan(volumes, -errors));
}
#endif

bool proven_apart(vec3 start, vec3 end) {
  bool apart = any(greaterThan(bounds[0].low.xyz, max(start, end))) ||
               any(lessThan(bounds[0].high.xyz, min(start, end)));
  vec3 size = max(abs(start), abs(end));
  bool computable = max(size.x, max(size.y, size.z)) <= kLargest;
  float margin = kMargin * dot(abs(bounds[0].normal), size) + kTiny;
  float along_start = dot(bounds[0].normal, start);
  float along_end = dot(bounds[0].normal, end);
  vec2 slab_end = vec2(bounds[0].low.w, bounds[0].high.w);
#if METHOD == VESTIGE_METHOD_STATIC
  vec2 slab_start = slab_end;
  bool beside = passes_beside(start, end);
#else
  vec2 slab_start = bounds[0].slab_start;
  bool beside = false;
#endif
  bool above = along_start - margin > slab_start.y && along_end - margin > slab_end.y;
  bool below = along_start + margin < slab_start.x && along_end + margin < slab_end.x;
  return apart || (computable && (above || below || beside));
}

void main() {
  Slot slot = slots[gl_PrimitiveIDIn / MESHLET_TRIANGLES];
  uint triangle = MESHLET_TRIANGLES * slot.touched + uint(gl_PrimitiveIDIn % MESHLET_TRIANGLES);
  uint i = 0u;
  do {
    GpuSegment segment = segments[slot.first + i];
    if (!proven_apart(segment.start.xyz, segment.end.xyz)) {
      uint place = atomicAdd(captured_count, 1u);
      if (place < capacity) captured[place] = uvec2(slot.offset + i, triangle);
    }
  } while (++i < slot.count);
}
