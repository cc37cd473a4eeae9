#pragma once

#include <optional>

#include "detector/decision.hpp"

/// The slow reference for the `exact` detector and for tests. It shares no deciding code with `decide_static` and
/// `decide_ccd`: it uses other formulas, other arithmetic (rational numbers) and another root finder.
namespace vestige::exact {

/// Returns what `decide_static` must return.
std::optional<FirstContact> static_contact(const Way& way, const Corners& triangle);

/// Returns what `decide_ccd` must return.
std::optional<FirstContact> ccd_contact(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige::exact
