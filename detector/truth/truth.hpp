#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>

#include "detector/decision.hpp"

/// The slow reference for the `exact` detector and for tests. It shares no deciding code with `decide_static`,
/// `decide_ccd` and `decide_sphere`: it uses other formulas, other arithmetic (rational numbers) and another root
/// finder.
namespace vestige::exact {

/// Returns what `decide_static` must return.
std::optional<FirstContact> static_contact(const Way& way, const Corners& triangle);

/// Returns what `decide_ccd` must return.
std::optional<FirstContact> ccd_contact(const Way& way, const Corners& before, const Corners& after);

/// Returns what `decide_sphere` must return.
std::optional<FirstTouch> sphere_contact(const MovingSphere& sphere, const Corners& before, const Corners& after);

/// Returns the exact squared distance from a point to a closed triangle.
boost::multiprecision::cpp_rational squared_distance(const glm::dvec3& point, const Corners& triangle);

}  // namespace vestige::exact
