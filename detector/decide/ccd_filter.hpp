#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// The part of the answer that double precision can prove for a moving point and a moving triangle.
struct CcdProof {
  enum class Verdict { kNoContact, kContact, kUnsure };
  Verdict verdict = Verdict::kUnsure;
  FirstContact contact = {};  ///< with kContact
};

/// Proves that point and triangle do not meet, or proves when they first meet, or gives up. The answer is never wrong,
/// for all finite doubles. How often the filter gives up only affects the speed. The work is bounded: the filter
/// examines at most 40 parts of the motion.
CcdProof filter_ccd(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
