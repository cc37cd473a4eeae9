// Writes the contact from the geometry shader into the planes of the collision texture.

flat in float contact_actuator;
layout(location = VESTIGE_PLANE_ACTUATOR) out float plane_actuator;
#if PLANES & (1 << VESTIGE_PLANE_TIME)
flat in float contact_time;
layout(location = VESTIGE_PLANE_TIME) out float plane_time;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TRIANGLE)
flat in uint contact_triangle;
layout(location = VESTIGE_PLANE_TRIANGLE) out uint plane_triangle;
#endif
#if PLANES & (1 << VESTIGE_PLANE_BARYCENTRIC)
flat in vec2 contact_barycentric;
layout(location = VESTIGE_PLANE_BARYCENTRIC) out vec2 plane_barycentric;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TEXTURE_COORDINATE)
flat in vec2 contact_texture_coordinate;
layout(location = VESTIGE_PLANE_TEXTURE_COORDINATE) out vec2 plane_texture_coordinate;
#endif
#if PLANES & (1 << VESTIGE_PLANE_POSITION)
flat in vec3 contact_position;
layout(location = VESTIGE_PLANE_POSITION) out vec4 plane_position;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SPEED)
flat in float contact_speed;
layout(location = VESTIGE_PLANE_SPEED) out float plane_speed;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SIDE)
flat in float contact_side;
layout(location = VESTIGE_PLANE_SIDE) out float plane_side;
#endif

void main() {
  plane_actuator = contact_actuator;
#if PLANES & (1 << VESTIGE_PLANE_TIME)
  plane_time = contact_time;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TRIANGLE)
  plane_triangle = contact_triangle;
#endif
#if PLANES & (1 << VESTIGE_PLANE_BARYCENTRIC)
  plane_barycentric = contact_barycentric;
#endif
#if PLANES & (1 << VESTIGE_PLANE_TEXTURE_COORDINATE)
  plane_texture_coordinate = contact_texture_coordinate;
#endif
#if PLANES & (1 << VESTIGE_PLANE_POSITION)
  plane_position = vec4(contact_position, 0.0);
#endif
#if PLANES & (1 << VESTIGE_PLANE_SPEED)
  plane_speed = contact_speed;
#endif
#if PLANES & (1 << VESTIGE_PLANE_SIDE)
  plane_side = contact_side;
#endif
}
