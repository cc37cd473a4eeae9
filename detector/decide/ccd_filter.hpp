#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// What double precision can prove about a moving point and a moving triangle.
struct CcdProof {
  enum class Verdict { kNoContact, kContact, kUnsure };
  Verdict verdict = Verdict::kUnsure;
  FirstContact contact = {};  ///< with kContact
};

/// Proves that point and triangle do not meet, or when they first do, or gives up. Never wrong, for all finite doubles;
/// how often it gives up is a matter of speed alone. Bounded: at most 40 parts of the motion are looked at.
CcdProof filter_ccd(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
