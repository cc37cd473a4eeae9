// The compute stage around candidates.glsl: a thread for each lane of a slot. All threads together stride over the
// slots of the block.

layout(local_size_x = GROUP_THREADS) in;

layout(location = VESTIGE_UNIFORM_SLOT_COUNT) uniform uint slot_count;

void main() {
  uint stride = gl_NumWorkGroups.x * (GROUP_THREADS / LANES);
  uint lane = gl_GlobalInvocationID.x % LANES;
  for (uint number = gl_GlobalInvocationID.x / LANES; number < slot_count; number += stride) test_triangles(number, lane);
}
