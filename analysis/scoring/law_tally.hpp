#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/scoring/link_load.hpp"
#include "analysis/scoring/slide_score.hpp"
#include "analysis/scoring/timing_score.hpp"
#include "detector/actuators/actuator_layout.hpp"

namespace vestige {

/// What one law and its motors did over a recording: everything that a metric is computed from.
struct LawTally {
  LawTally(const ActuatorLayout& judged, double line_rate_bytes_per_s, std::optional<double> unfelt_counts_m)
      : layout(&judged),
        line_bytes_per_s(line_rate_bytes_per_s),
        unfelt_m(unfelt_counts_m),
        timing(judged.actuator_count()),
        link(state_bytes(judged.actuator_count()), line_rate_bytes_per_s),
        use(judged.actuator_count(), 0) {}

  const ActuatorLayout* layout;
  double line_bytes_per_s;
  std::optional<double> unfelt_m;  ///< the error that a contact counts with which is not felt
  std::size_t frames = 0;
  double duration_s = 0;

  std::uint64_t contacts = 0;
  /// Contacts that are felt: at least one actuator vibrates for them, and strongly enough if the motors have a
  /// threshold. The sums of squares cover only these.
  std::uint64_t felt = 0;
  double squared_error_m2 = 0;
  double squared_acuities = 0;
  double squared_energy_error_m2 = 0;
  std::uint64_t common = 0;  ///< contacts that are felt under every layout and law that is compared
  double squared_common_error_m2 = 0;

  SlideScore slides;
  TimingScore timing;
  LinkLoad link;
  double information_bits = 0;
  std::vector<double> use;     ///< sum over frames of each actuator's duty 0 … 1
  double peak = 0;             ///< largest sum of duties in a frame
  std::uint64_t switches = 0;  ///< how often an actuator began to vibrate
};

}  // namespace vestige
