#include "analysis/mapping/scores.hpp"

#include <limits>

namespace vestige {

namespace {

constexpr Metric kMetrics[] = {
    {"coverage", "", Better::kHigher, false, "contacts that fire anything / contacts", ""},
};

}  // namespace

std::span<const Metric> metrics() {
  return kMetrics;
}

std::vector<Scores> score_all(const ContactRecording&, const ActuatorLayout&, std::span<const LawChoice> laws) {
  return std::vector<Scores>(laws.size(), Scores(metrics().size(), std::numeric_limits<double>::quiet_NaN()));
}

Scores score(const ContactRecording& recording, const ActuatorLayout& layout, const LawChoice& law) {
  return score_all(recording, layout, {&law, 1}).front();
}

std::vector<float> contact_errors_mm(const ContactRecording& recording, const ActuatorLayout&, const LawChoice&) {
  return std::vector<float>(recording.contacts.size(), std::numeric_limits<float>::quiet_NaN());
}

}  // namespace vestige
