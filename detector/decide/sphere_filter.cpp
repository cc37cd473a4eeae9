#include "detector/decide/sphere_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "detector/decide/bounded.hpp"
#include "detector/decide/ccd_formulas.hpp"
#include "detector/decide/triangle_distance.hpp"

namespace vestige {

namespace {

constexpr int kMostSteps = 64;
/// Shorter steps are lost in the rounding of t.
constexpr double kShortestStep = 0x1p-45;
/// Once steps are this short, a time of contact is looked for.
constexpr double kShortStep = 0x1p-20;

constexpr SphereProof kNoTouch = {SphereProof::Verdict::kNoTouch, {}};
constexpr SphereProof kNotProven = {SphereProof::Verdict::kUnsure, {}};

Corners relative_to(const glm::dvec3& centre, const Corners& triangle) {
  return {triangle.a - centre, triangle.b - centre, triangle.c - centre};
}

/// Returns the exact midpoint between an fp32 number >= 0 and the next one.
double middle_above(float t) {
  const float next = std::nextafter(t, HUGE_VALF);
  return 0.5 * (double{t} + double{next});
}

class ConservativeAdvance {
 public:
  ConservativeAdvance(const MovingSphere& sphere, const Corners& before, const Corners& after)
      : radius_(sphere.radius),
        first_(relative_to(sphere.centre.start, before)),
        last_(relative_to(sphere.centre.end, after)),
        reach_(std::max(reach_of(first_), reach_of(last_))) {
    const double fastest =
        std::max({glm::length(last_.a - first_.a), glm::length(last_.b - first_.b), glm::length(last_.c - first_.c)});
    speed_ = fastest * (1 + 16 * kUnit) + 16 * kUnit * reach_;
  }

  bool in_range() const { return is_in_range(reach_); }

  SphereProof run() const {
    Separation separation = separation_at(0);
    if (separation.range.high <= radius_) return touch({0, 0, true}, 0, 0);
    double t = 0;
    for (int step = 0; step < kMostSteps; ++step) {
      const double wait = time_apart(t, separation);
      if (!(wait >= kShortestStep)) return kNotProven;
      t += wait - kShortestStep / 2;  // not beyond t + wait, even when rounded: the gap still lasts at this time
      if (t >= 1) return kNoTouch;
      if (wait <= kShortStep)
        if (const auto proof = touch_after(t)) return *proof;
      separation = separation_at(t);
    }
    return kNotProven;
  }

 private:
  Corners corners_at(double t) const {
    return {corner_at(first_.a, last_.a, t), corner_at(first_.b, last_.b, t), corner_at(first_.c, last_.c, t)};
  }

  Separation separation_at(double t) const { return separation_from(corners_at(t), reach_); }

  /// Returns how long from `t` on, within the frame, the triangle surely stays farther away than the radius. Two
  /// bounds: no distance changes faster than the fastest corner, and along a fixed direction the corners move linearly.
  ///
  /// Let u = kUnit. A corner's place errs by 4 u reach, its motion by 4 u reach in a frame, both products by 3 u reach
  /// more, and the direction's length by 6 u: less than 32 u reach in all, and 8 u of the radius.
  double time_apart(double t, const Separation& separation) const {
    const Corners now = corners_at(t);
    const double limit = radius_ * (1 + 16 * kUnit) + 64 * kUnit * reach_;
    double wait = 2;
    for (const auto& [corner, motion] : {std::pair(now.a, last_.a - first_.a), std::pair(now.b, last_.b - first_.b),
                                         std::pair(now.c, last_.c - first_.c)}) {
      const double gap = glm::dot(corner, separation.direction) - limit;
      if (!(gap > 0)) return 0;
      const double approach = -glm::dot(motion, separation.direction);
      if (approach > 0) wait = std::min(wait, gap / approach * (1 - 8 * kUnit));
    }
    return std::max(wait, (separation.range.low - radius_) * (1 - 16 * kUnit) / speed_);
  }

  /// Given that nothing touches up to `t`: proves a first touch that rounds as `t` does, or returns nothing.
  std::optional<SphereProof> touch_after(double t) const {
    const auto rounded = static_cast<float>(t);
    const double late = std::min(1.0, std::nextafter(middle_above(rounded), 0.0));
    if (late <= t || separation_at(late).range.high > radius_) return {};
    return touch({rounded, 0, false}, t, late);
  }

  /// Completes a touch between these times by its side.
  SphereProof touch(FirstTouch touch, double from, double to) const {
    const Corners at = corners_at(from);
    const double volume = -dot_product(at.a, cross_product(at.b, at.c));
    const glm::dvec3 most = glm::max(glm::max(glm::max(glm::abs(first_.a), glm::abs(first_.b)), glm::abs(first_.c)),
                                     glm::max(glm::max(glm::abs(last_.a), glm::abs(last_.b)), glm::abs(last_.c)));
    // Within (to - from), each coordinate changes by 2 (to - from) of its greatest size at most, and each of the six
    // products of three coordinates by less than 7 (to - from) of the greatest.
    const double error = (kVolumeError + 48 * (to - from)) * (most.x * most.y * most.z);
    if (!(std::abs(volume) > error) || error < kLeastVolumeError) return kNotProven;
    touch.side = volume > 0 ? 1 : -1;
    return {SphereProof::Verdict::kTouch, touch};
  }

  /// Below this bound, products may have lost bits to underflow.
  static constexpr double kLeastVolumeError = 0x1p-1000;

  double radius_;
  Corners first_;  ///< relative to the centre
  Corners last_;
  double reach_;
  double speed_ = 0;  ///< of the fastest corner, rounded up; the distance changes no faster
};

}  // namespace

SphereProof filter_sphere(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const ConservativeAdvance advance(sphere, before, after);
  return advance.in_range() ? advance.run() : kNotProven;
}

}  // namespace vestige
