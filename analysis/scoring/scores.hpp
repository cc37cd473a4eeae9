#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/scoring/contact_recording.hpp"
#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"

namespace vestige {

/// An intensity law, and the motors that it drives.
struct LawChoice {
  std::string name = "binary";  ///< as `make_law` takes it
  LawOptions options;
  std::shared_ptr<const ActuatorModel> actuators;  ///< null: ideal ones, that do at once what they are told
  double line_bytes_per_s = 5760;                  ///< of the link to the vest: 57600 baud, ten bits a byte
};

enum class Better { kHigher, kLower, kNeither };

/// One number that a mapping is judged by. Names are columns of files and never change their meaning.
struct Metric {
  const char* name;
  const char* unit;
  Better better;
  bool model_based;  ///< computed by a model of perception, motors or link: no user study
  const char* formula;
  const char* source;
};

std::span<const Metric> metrics();

/// In the order of `metrics()`; NaN where undefined: no contact, no slide.
using Scores = std::vector<double>;

/// Judges a layout under each of the laws. Throws what `make_law` and `ActuatorModel::motors` throw.
std::vector<Scores> score_all(const ContactRecording& recording, const ActuatorLayout& layout,
                              std::span<const LawChoice> laws);
Scores score(const ContactRecording& recording, const ActuatorLayout& layout, const LawChoice& law);

/// For each contact of the recording, millimetres along the body from where it is to where it is felt, as
/// `localisation_error_mm` has it; NaN where nothing fires.
std::vector<float> contact_errors_mm(const ContactRecording& recording, const ActuatorLayout& layout,
                                     const LawChoice& law);

}  // namespace vestige
