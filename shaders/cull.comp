// Finds which segments may meet which meshlets, and skins those meshlets: a group of threads for each meshlet. It
// follows candidates.glsl, which then proves misses, slot by slot.
//
// The meshlet's box is computed as detector/broad/meshlet_bounds.cpp does, from the same rest boxes. That derivation
// holds for any order of the sums, with fma or without. `box_margin` covers it, and flushed denormals
// (detector/proofs/gpu_culler.cpp).
//
// Each thread counts the segments that it tested and the corners that it skinned, so that a driver that ends these loops
// early is noticed by the sums. The other loops are short: over the boxes of a meshlet and the influences of a vertex.

layout(local_size_x = GROUP_THREADS) in;

struct RestBox {
  vec3 centre;
  uint entry;
  vec3 half_extent;
  float padding;
};
struct Meshlet {
  uint first_box;
  uint boxes;             // none: nothing is known of where the meshlet is
  uint vertices[CORNERS];  // corner a of all triangles, then b and c
};
struct Vertex {
  vec4 position_bind;
  uvec4 entries[INFLUENCES / 4];
  vec4 weights[INFLUENCES / 4];
};
layout(std430, binding = VESTIGE_BINDING_MESHLETS) readonly buffer Meshlets {
  Meshlet meshlets[];
};
layout(std430, binding = VESTIGE_BINDING_REST_BOXES) readonly buffer RestBoxes {
  RestBox rest_boxes[];
};
layout(std430, binding = VESTIGE_BINDING_VERTICES) readonly buffer Vertices {
  Vertex vertices[];
};
// Now and, except for `static`, before.
layout(std430, binding = VESTIGE_BINDING_PALETTE) readonly buffer Palette {
  mat4x3 palette[];
};
// As `corners` of candidates.glsl has them.
layout(std430, binding = VESTIGE_BINDING_CULLED_CORNERS) writeonly buffer CulledCorners {
  float culled_corners[];
};

layout(location = VESTIGE_UNIFORM_SEGMENT_COUNT) uniform uint segment_count;
layout(location = VESTIGE_UNIFORM_PALETTE_SIZE) uniform uint palette_size;
layout(location = VESTIGE_UNIFORM_BOX_MARGIN) uniform float box_margin;

const uint kPartSegments = 512u;  // that are listed at once
const uint kNowhere = 0xFFFFFFFFu;
const float kFar = 3.402823466e38;

shared uint met[kPartSegments];
shared uint met_count;
shared uint part_first_slot;
shared uint place;
shared uint group_tested;
shared uint group_skinned;

struct Box {
  vec3 low;
  vec3 high;
};

void include(inout Box box, mat4x3 matrix, RestBox rest) {
  vec3 centre = matrix[0] * rest.centre.x + matrix[1] * rest.centre.y + matrix[2] * rest.centre.z + matrix[3];
  vec3 extent = abs(matrix[0]) * rest.half_extent.x + abs(matrix[1]) * rest.half_extent.y +
                abs(matrix[2]) * rest.half_extent.z;
  box.low = min(box.low, centre - extent);
  box.high = max(box.high, centre + extent);
}

Box box_of_meshlet(uint meshlet) {
  uint boxes = meshlets[meshlet].boxes;
  if (boxes == 0u) return Box(vec3(-kFar), vec3(kFar));
  Box box = Box(vec3(kFar), vec3(-kFar));
#if METHOD == VESTIGE_METHOD_CARRIED
  Box moved = box;
#endif
  for (uint i = 0u; i < boxes; ++i) {
    RestBox rest = rest_boxes[meshlets[meshlet].first_box + i];
    include(box, palette[rest.entry], rest);
#if METHOD == VESTIGE_METHOD_CCD
    include(box, palette[palette_size + rest.entry], rest);
#elif METHOD == VESTIGE_METHOD_CARRIED
    include(moved, palette[rest.entry] - palette[palette_size + rest.entry], rest);
#endif
  }
#if METHOD == VESTIGE_METHOD_CARRIED
  box.low -= max(moved.high, vec3(0.0));
  box.high -= min(moved.low, vec3(0.0));
#endif
  return Box(box.low - box_margin, box.high + box_margin);
}

bool surely_misses(Box box, GpuSegment segment) {
  vec3 low;
  vec3 high;
  box_of(segment, low, high);
  return largest_of(max(box.low - high, low - box.high)) > 0.0;
}

// Lists the segments from number `first` on that may meet the box. Returns how many this thread tested.
uint list_part(Box box, uint first, uint thread) {
  uint end = min(first + kPartSegments, segment_count);
  uint done = 0u;
  for (uint i = first + thread; i < end; i += GROUP_THREADS) {
    if (!surely_misses(box, segments[i])) met[atomicAdd(met_count, 1u)] = i;
    ++done;
  }
  return done;
}

// Makes room for the listed segments, and for the meshlet's corners.
void reserve() {
  if (met_count == 0u) return;
  uint needed = (met_count + SLOT_SEGMENTS - 1u) / SLOT_SEGMENTS;
  part_first_slot = atomicAdd(slot_count, needed);
  atomicMax(groups_x, (min(part_first_slot + needed, MOST_SLOTS) * LANES + GROUP_THREADS - 1u) / GROUP_THREADS);
  atomicAdd(pairs, met_count);
  if (place == kNowhere) place = atomicAdd(place_count, 1u);
}

void write_slots(uint meshlet, uint thread) {
  for (uint i = thread; i * SLOT_SEGMENTS < met_count && part_first_slot + i < MOST_SLOTS; i += GROUP_THREADS) {
    uint slot = part_first_slot + i;
    uint count = min(met_count - i * SLOT_SEGMENTS, SLOT_SEGMENTS);
    slots[slot].meshlet = meshlet;
    slots[slot].count = count;
    slots[slot].place = place;
    for (uint k = 0u; k < count; ++k) slots[slot].segments[k] = met[i * SLOT_SEGMENTS + k];
  }
}

vec3 skin(Vertex vertex, uint first_entry) {
  mat4x3 blend = mat4x3(0.0);
  for (int part = 0; part < INFLUENCES / 4; ++part)
    for (int i = 0; i < 4; ++i) blend += vertex.weights[part][i] * palette[first_entry + vertex.entries[part][i]];
  vec3 bind = vertex.position_bind.xyz;
  return blend[0] * bind.x + blend[1] * bind.y + blend[2] * bind.z + blend[3];
}

// Returns how many corners this thread skinned.
uint skin_corners(uint meshlet, uint thread) {
  uint done = 0u;
  for (uint i = thread; i < SETS * CORNERS; i += GROUP_THREADS) {
    uint set = i / CORNERS;
    uint corner = i % CORNERS;
    vec3 position = skin(vertices[meshlets[meshlet].vertices[corner]], set * palette_size);
    for (uint axis = 0u; axis < 3u; ++axis)
      culled_corners[((place * SETS + set) * 3u + axis) * CORNERS + corner] = position[axis];
    ++done;
  }
  return done;
}

void main() {
  uint meshlet = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationID.x;
  if (thread == 0u) {
    place = kNowhere;
    group_tested = 0u;
    group_skinned = 0u;
  }
  Box box = box_of_meshlet(meshlet);
  uint done = 0u;
  for (uint first = 0u; first < segment_count; first += kPartSegments) {
    if (thread == 0u) met_count = 0u;
    barrier();
    done += list_part(box, first, thread);
    barrier();
    if (thread == 0u) reserve();
    barrier();
    write_slots(meshlet, thread);
    barrier();
  }
  atomicAdd(group_tested, done);
  if (place < MOST_PLACES) atomicAdd(group_skinned, skin_corners(meshlet, thread));
  barrier();
  if (thread == 0u) {
    atomicAdd(tested, group_tested);
    atomicAdd(corners_skinned, group_skinned);
  }
}
