// Draws skin lit by a lamp beside the viewer, flat-shaded by triangle; colliders are plain dots.

in vec3 position_world;
layout(location = 0) out vec4 colour;

void main() {
#if COLLIDERS
  colour = vec4(0.1, 0.35, 0.9, 1.0);
#else
  vec3 normal = normalize(cross(dFdx(position_world), dFdy(position_world)));
  float light = 0.3 + 0.7 * max(dot(normal, normalize(vec3(0.4, 0.5, 1.0))), 0.0);
  colour = vec4(light * vec3(0.87, 0.67, 0.54), 1.0);
#endif
}
