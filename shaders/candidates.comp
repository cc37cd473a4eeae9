// The compute stage around candidates.glsl: a thread for each lane of a slot. All threads together stride over the
// slots of the block, or, if cull.comp wrote them, over all slots that it had room for.

layout(local_size_x = GROUP_THREADS) in;

#if CULLED_ON_GPU
// The slots themselves, for the CPU.
layout(std430, binding = VESTIGE_BINDING_FOUND) writeonly buffer Found {
  Slot found[];
};
#else
layout(location = VESTIGE_UNIFORM_SLOT_COUNT) uniform uint slot_count;
#endif

void main() {
  uint stride = gl_NumWorkGroups.x * (GROUP_THREADS / LANES);
  uint lane = gl_GlobalInvocationID.x % LANES;
#if CULLED_ON_GPU
  uint slots_to_test = min(slot_count, MOST_SLOTS);
#else
  uint slots_to_test = slot_count;
#endif
  for (uint number = gl_GlobalInvocationID.x / LANES; number < slots_to_test; number += stride) {
#if CULLED_ON_GPU
    if (lane == 0u) found[number] = slots[number];
#endif
    test_triangles(number, lane);
  }
}
