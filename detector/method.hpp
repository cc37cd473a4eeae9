#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// How the detector combines a collider's motion and the motion of the skin within a frame.
///
/// kStatic: the segment against the triangle as it is now, as in HAVE 2010 §III.A. kCarried: a heuristic that first
/// moves the segment's start by the mean of the triangle's vertex displacements; it does not promise watertightness.
/// kCcd: continuous collision detection; collider and triangle both move linearly from the previous frame to this one.
enum class Method { kStatic, kCarried, kCcd };

/// "static", "carried", "ccd".
constexpr const char* name_of(Method method) {
  return method == Method::kStatic ? "static" : (method == Method::kCarried ? "carried" : "ccd");
}

/// The names of all methods.
inline const std::vector<std::string> kMethodNames = {name_of(Method::kStatic), name_of(Method::kCarried),
                                                      name_of(Method::kCcd)};

/// Returns the method of this name. Throws `std::logic_error` if it is not one of `kMethodNames`.
inline Method method_named(std::string_view name) {
  for (const Method method : {Method::kStatic, Method::kCarried, Method::kCcd})
    if (name_of(method) == name) return method;
  throw std::logic_error("there is no method '" + std::string(name) + "'");
}

/// kOn: the detector discards meshlets and colliders that cannot meet before it skins or tests anything. This changes
/// the work, but no bit of the result. Detectors that test all pairs by design ignore the option.
enum class Skip { kOff, kOn };

}  // namespace vestige
