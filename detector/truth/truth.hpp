#pragma once

#include <optional>

#include "detector/decision.hpp"

/// The slow truth, for the `exact` detector and for tests. It shares no deciding code with `decide_static` and
/// `decide_ccd`: other formulas, other arithmetic (rational numbers), other root finding.
namespace vestige::exact {

/// What `decide_static` must answer.
std::optional<FirstContact> static_contact(const Way& way, const Corners& triangle);

/// What `decide_ccd` must answer.
std::optional<FirstContact> ccd_contact(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige::exact
