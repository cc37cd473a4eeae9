#include "detector/decide/sphere_exact.hpp"
#include "detector/decide/sphere_filter.hpp"
#include "detector/decision.hpp"

namespace vestige {

SphereDecision decide_sphere(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const SphereProof proof = filter_sphere(sphere, before, after);
  switch (proof.verdict) {
    case SphereProof::Verdict::kNoTouch:
      return {};
    case SphereProof::Verdict::kTouch:
      return {proof.touch, false};
    case SphereProof::Verdict::kUnsure:
      break;
  }
  return {sphere_in_integers(sphere, before, after), true};
}

}  // namespace vestige
