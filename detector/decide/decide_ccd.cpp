#include "detector/decide/ccd_exact.hpp"
#include "detector/decide/ccd_filter.hpp"
#include "detector/decision.hpp"

namespace vestige {

Decision decide_ccd(const Way& way, const Corners& before, const Corners& after) {
  const CcdProof proof = filter_ccd(way, before, after);
  switch (proof.verdict) {
    case CcdProof::Verdict::kNoContact:
      return {};
    case CcdProof::Verdict::kContact:
      return {proof.contact, false};
    case CcdProof::Verdict::kUnsure:
      break;
  }
  return {ccd_in_integers(way, before, after), true};
}

}  // namespace vestige
