#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// The part of the answer that double precision can prove for a moving sphere and a moving triangle.
struct SphereProof {
  enum class Verdict { kNoTouch, kTouch, kUnsure };
  Verdict verdict = Verdict::kUnsure;
  FirstTouch touch = {};  ///< with kTouch
};

/// Proves that the sphere and the triangle do not touch, or proves when they first touch, or gives up. The answer is
/// never wrong, for all finite doubles: it gives up where numbers are too large or too small for its bounds. How often
/// the filter gives up only affects the speed. It advances time conservatively (Mirtich 1996, Impulse-based Dynamic
/// Simulation of Rigid Body Systems, 2.3): along the direction of the nearest point, corners move linearly, so it is
/// known how long a gap along it lasts. At most 64 steps.
SphereProof filter_sphere(const MovingSphere& sphere, const Corners& before, const Corners& after);

}  // namespace vestige
