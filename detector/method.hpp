#pragma once

namespace vestige {

/// How a collider's way and the moving skin meet within a frame.
///
/// kStatic: the segment against the triangle as it is now, as HAVE 2010 §III.A does. kCarried: a heuristic; the
/// segment's start is first moved by the mean of the triangle's vertex displacements; it promises no watertightness.
/// kCcd: continuous collision detection; collider and triangle both move linearly from the frame before to this one.
enum class Method { kStatic, kCarried, kCcd };

/// "static", "carried", "ccd".
constexpr const char* name_of(Method method) {
  return method == Method::kStatic ? "static" : (method == Method::kCarried ? "carried" : "ccd");
}

}  // namespace vestige
