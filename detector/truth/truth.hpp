#pragma once

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

/// A point and a closed triangle, for their distance.
struct Apart {
  glm::dvec3 point;
  Corners triangle;
};

/// Returns -1, 0 or 1 if the distance of `a` is less than, equal to or greater than that of `b`.
int compare_distances(const Apart& a, const Apart& b);
/// The same for a distance and a length >= 0.
int compare_distance(const Apart& a, double length);

}  // namespace vestige::exact
