#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige::test {

/// Returns the frames of a timeline's CSV.
inline std::vector<ActuatorFrame> read_timeline_csv(const std::string& csv) {
  std::vector<ActuatorFrame> frames;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    ActuatorFrame frame{std::stod(field), {}};
    while (std::getline(fields, field, ',')) frame.duty.push_back(static_cast<std::uint8_t>(std::stoi(field)));
    frames.push_back(frame);
  }
  return frames;
}

/// Returns the complaints of the schemas about a .hjif file; empty if there are none.
inline std::string hjif_complaints(const std::filesystem::path& file) {
  const Outcome outcome = run("python3 '" VESTIGE_SOURCE_DIR "/tests/traces/timeline/validate_hjif.py' '" +
                                  data("hjif").string() + "' '" + file.string() + "'",
                              "/");
  if (outcome.exit_code == 0) return "";
  return "exit code " + std::to_string(outcome.exit_code) + "\n" + outcome.standard_output + outcome.standard_error;
}

/// Returns the duty in a .hjif file's curve for an actuator (from 0) at a time in milliseconds. NaN outside the curve.
inline double hjif_duty(const nlohmann::json& hjif, std::size_t actuator, double time_ms) {
  const auto& keyframes =
      hjif.at("perceptions").at(0).at("channels").at(actuator).at("bands").at(0).at("effects").at(0).at("keyframes");
  const auto time_of = [](const nlohmann::json& keyframe) { return keyframe.at("relative_position").get<double>(); };
  const auto duty_of = [](const nlohmann::json& keyframe) {
    return 255 * keyframe.at("amplitude_modulation").get<double>();
  };
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const double next_ms = time_of(keyframes[i]);
    if (time_ms == next_ms) return duty_of(keyframes[i]);
    if (time_ms > next_ms) continue;
    if (i == 0) return NAN;
    const double last_ms = time_of(keyframes[i - 1]);
    const double share = (time_ms - last_ms) / (next_ms - last_ms);
    return (1 - share) * duty_of(keyframes[i - 1]) + share * duty_of(keyframes[i]);
  }
  return NAN;  // after the end
}

/// Returns what a .tact file must say about an actuator in the 20 ms from `start_ms` on: the largest duty in percent. A
/// frame holds until the next one. The last frame counts only at its own instant.
inline int expected_percent(const std::vector<ActuatorFrame>& frames, std::size_t actuator, long start_ms) {
  int largest = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const long from_us = std::lround((frames[k].time_s - frames[0].time_s) * 1e6);
    const long until_us =
        k + 1 < frames.size() ? std::lround((frames[k + 1].time_s - frames[0].time_s) * 1e6) : from_us + 1;
    if (from_us >= (start_ms + 20) * 1000 || until_us <= start_ms * 1000) continue;
    largest = std::max<int>(largest, frames[k].duty[actuator]);
  }
  return static_cast<int>(std::lround(largest * 100 / 255.0));
}

}  // namespace vestige::test
