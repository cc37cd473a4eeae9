#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/scoring/contact_recording.hpp"
#include "analysis/scoring/metrics.hpp"
#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"

namespace vestige {

/// An intensity law, and the motors that it drives.
struct LawChoice {
  std::string name = "binary";  ///< a name that `make_law` knows
  LawOptions options;
  std::shared_ptr<const ActuatorModel> actuators;  ///< null: ideal motors, which follow at once
  double line_bytes_per_s = 5760;                  ///< link to the vest: 57600 baud, ten bits a byte
  /// The error in metres that a contact counts with which is not felt, in `error_with_unfelt_mm`; empty: that metric is
  /// undefined.
  std::optional<double> unfelt_m;
};

/// A layout to score, and what the recording's contacts cover of its actuators; null if no law needs that.
struct ScoredLayout {
  const ActuatorLayout* layout = nullptr;
  const CoveredPlaces* covered = nullptr;
};

/// Scores in the order of `metrics()`. A score is NaN if it is undefined, for example without contacts or slides.
using Scores = std::vector<double>;

/// Returns the scores of each layout under each of the laws, layout by layout. They are compared with each other: what
/// `common_error_mm` covers are the contacts that all of them let feel. Throws what `make_law` and
/// `ActuatorModel::motors` throw.
std::vector<Scores> score_all(const ContactRecording& recording, std::span<const ScoredLayout> layouts,
                              std::span<const LawChoice> laws);
/// As above, of one layout.
std::vector<Scores> score_all(const ContactRecording& recording, const ScoredLayout& layout,
                              std::span<const LawChoice> laws);
Scores score(const ContactRecording& recording, const ScoredLayout& layout, const LawChoice& law);

/// Returns for each contact of the recording the distance along the body from where the contact is to where it is felt,
/// in millimetres, as in `localisation_error_mm`. NaN if no actuator is felt.
std::vector<float> contact_errors_mm(const ContactRecording& recording, const ScoredLayout& layout,
                                     const LawChoice& law);

}  // namespace vestige
