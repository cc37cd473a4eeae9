// The points that candidates.geom works on have no place.
void main() {
  gl_Position = vec4(0.0);
}
