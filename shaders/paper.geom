// Tests one triangle against its share of the segments. Emits one point for each contact, to the collider's pixel of the
// collision texture: HAVE 2010 §III.A. The test is Möller & Trumbore 1997, "Fast, Minimum Storage Ray/Triangle
// Intersection", in fp32. `precise` forbids contraction and reordering, which may depend on the planes and the
// number of segments that the program is compiled for. A division may still differ: GLSL lets it err by 2.5 ulp. Depth
// is t / 2, so the depth test keeps the earliest contact (the paper does not say which contact is kept).

layout(triangles, invocations = INVOCATIONS) in;
layout(points, max_vertices = SHARE_SEGMENTS) out;

in Skinned {
  vec3 position;
  vec2 texture_coordinate;
  flat int instance;
} skinned[];

struct GpuSegment {
  vec3 start;
  uint column;
  vec3 end;
  uint unused;
};
layout(std430, binding = VESTIGE_BINDING_SEGMENTS) readonly buffer Segments {
  GpuSegment segments[];
};

layout(binding = VESTIGE_TEXTURE_ACTUATOR_MAP) uniform usampler2D actuator_map;

layout(location = VESTIGE_UNIFORM_SEGMENT_COUNT) uniform int segment_count;
layout(location = VESTIGE_UNIFORM_TEXTURE_COLUMNS) uniform int texture_columns;
layout(location = VESTIGE_UNIFORM_TEXTURE_ROWS) uniform int texture_rows;
layout(location = VESTIGE_UNIFORM_FRAMES_PER_S) uniform float frames_per_s;

flat out float contact_actuator;
#if PLANES & (1 << VESTIGE_PLANE_TIME)
flat out float contact_time;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TRIANGLE)
flat out uint contact_triangle;
#endif
#if PLANES & (1 << VESTIGE_PLANE_BARYCENTRIC)
flat out vec2 contact_barycentric;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TEXTURE_COORDINATE)
flat out vec2 contact_texture_coordinate;
#endif
#if PLANES & (1 << VESTIGE_PLANE_POSITION)
flat out vec3 contact_position;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SPEED)
flat out float contact_speed;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SIDE)
flat out float contact_side;
#endif

void main() {
  vec3 a = skinned[0].position;
  precise vec3 edge_1 = skinned[1].position - a;
  precise vec3 edge_2 = skinned[2].position - a;
  int first = (skinned[0].instance * INVOCATIONS + gl_InvocationID) * SHARE_SEGMENTS;
  int last = min(first + SHARE_SEGMENTS, segment_count);
  for (int i = first; i < last; ++i) {
    vec3 start = segments[i].start;
    precise vec3 direction = segments[i].end - start;
    precise vec3 p = cross(direction, edge_2);
    precise float determinant = dot(edge_1, p);
    if (determinant == 0.0) continue;  // parallel
    precise float inverse = 1.0 / determinant;
    precise vec3 from_a = start - a;
    precise float u = dot(from_a, p) * inverse;
    if (!(u >= 0.0 && u <= 1.0)) continue;
    precise vec3 q = cross(from_a, edge_1);
    precise float v = dot(direction, q) * inverse;
    if (!(v >= 0.0 && u + v <= 1.0)) continue;
    precise float t = dot(edge_2, q) * inverse;
    if (!(t >= 0.0 && t <= 1.0)) continue;
    t = abs(t);  // never -0

    precise vec2 texture_coordinate = skinned[0].texture_coordinate +
                              u * (skinned[1].texture_coordinate - skinned[0].texture_coordinate) +
                              v * (skinned[2].texture_coordinate - skinned[0].texture_coordinate);
#if MAP_PER_TRIANGLE
    int map_width = textureSize(actuator_map, 0).x;
    uint actuator = texelFetch(actuator_map, ivec2(gl_PrimitiveIDIn % map_width, gl_PrimitiveIDIn / map_width), 0).r;
#else
    uint actuator = textureLod(actuator_map, texture_coordinate, 0.0).r;
#endif
#if MAPPED_ONLY
    if (actuator == 0u) continue;
#endif
    // The collider's number in normalised device coordinates, at the pixel's centre. The texture has several rows if
    // one is not enough.
    int column = int(segments[i].column);
    vec2 pixel = vec2(column % texture_columns, column / texture_columns);
    vec2 device = (2.0 * pixel + 1.0) / vec2(texture_columns, texture_rows) - 1.0;
    gl_Position = vec4(device, 0.5 * t, 1.0);
    contact_actuator = float(actuator);
#if PLANES & (1 << VESTIGE_PLANE_TIME)
    contact_time = t;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TRIANGLE)
    contact_triangle = uint(gl_PrimitiveIDIn);
#endif
#if PLANES & (1 << VESTIGE_PLANE_BARYCENTRIC)
    contact_barycentric = vec2(u, v);
#endif
#if PLANES & (1 << VESTIGE_PLANE_TEXTURE_COORDINATE)
    contact_texture_coordinate = texture_coordinate;
#endif
#if PLANES & (1 << VESTIGE_PLANE_POSITION)
    contact_position = start + t * direction;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SPEED)
    contact_speed = abs(dot(direction, normalize(cross(edge_1, edge_2)))) * frames_per_s;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SIDE)
    contact_side = sign(determinant);
#endif
    EmitVertex();
    EndPrimitive();
  }
}
