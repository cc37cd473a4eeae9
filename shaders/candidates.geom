// The geometry stage around candidates.glsl: a point for each lane of each slot.

layout(points) in;
layout(points, max_vertices = 1) out;

void main() {
  test_triangles(uint(gl_PrimitiveIDIn) / LANES, uint(gl_PrimitiveIDIn) % LANES);
}
