#include "traces/timeline/timeline_hjif.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

namespace vestige {

using Json = nlohmann::ordered_json;

TimelineHjif::TimelineHjif(const std::filesystem::path& path, Overwrite overwrite,
                           std::vector<std::string> actuator_names)
    : file_(path, overwrite), actuator_names_(std::move(actuator_names)), curves_(actuator_names_.size()) {}

void TimelineHjif::write(const ActuatorFrame& frame) {
  if (!start_s_) start_s_ = frame.time_s;
  const std::int64_t time_ms = std::llround((frame.time_s - *start_s_) * 1e3);
  if (time_ms == time_ms_ && !duty_.empty()) {
    std::ranges::transform(duty_, frame.duty, duty_.begin(), [](auto a, auto b) { return std::max(a, b); });
    return;
  }
  add_keyframes();
  time_ms_ = time_ms;
  duty_ = frame.duty;
}

void TimelineHjif::add_keyframes() {
  for (std::size_t i = 0; i < duty_.size(); ++i) {
    std::vector<Keyframe>& curve = curves_[i];
    if (!curve.empty()) {
      const Keyframe last = curve.back();
      if (last.duty == duty_[i]) continue;
      if (last.time_ms < time_ms_ - 1) curve.push_back({time_ms_ - 1, last.duty});
    }
    curve.push_back({time_ms_, duty_[i]});
  }
}

void TimelineHjif::commit() {
  add_keyframes();
  Json channels = Json::array();
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    Json keyframes = Json::array();
    const auto add = [&](std::int64_t time_ms, std::uint8_t duty) {
      keyframes.push_back({{"relative_position", time_ms}, {"amplitude_modulation", duty / 255.0}});
    };
    for (const Keyframe& keyframe : curves_[i]) add(keyframe.time_ms, keyframe.duty);
    if (!curves_[i].empty() && curves_[i].back().time_ms < time_ms_) add(time_ms_, curves_[i].back().duty);
    const Json effect = {{"effect_type", "Basis"},
                         {"position", 0},
                         {"phase", 0},
                         {"base_signal", "Sine"},
                         {"keyframes", std::move(keyframes)}};
    const Json band = {{"band_type", "Curve"},
                       {"curve_type", "Linear"},
                       {"lower_frequency_limit", 0},
                       {"upper_frequency_limit", 1000},
                       {"effects", Json::array({effect})}};
    channels.push_back({{"id", i},
                        {"description", actuator_names_[i]},
                        {"gain", 1},
                        {"mixing_coefficient", 1},
                        {"body_part_mask", 0},
                        {"bands", Json::array({band})}});
  }
  const Json perception = {
      {"id", 0},        {"perception_modality", "Vibrotactile"}, {"description", "Duties of the actuators, 1 is full"},
      {"avatar_id", 1}, {"effect_library", Json::array()},       {"channels", std::move(channels)}};
  // syncs, timescale and body_part_mask are optional in the schema, but readers require them.
  const Json file = {{"version", "2023"},
                     {"profile", "Simple Parametric"},
                     {"level", 1},
                     {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
                     {"description", fmt::format("Vestige: {} actuators, {} ms", curves_.size(), time_ms_)},
                     {"timescale", 1000},
                     {"avatars", Json::array({{{"id", 1}, {"lod", 0}, {"type", "Vibration"}}})},
                     {"perceptions", Json::array({perception})},
                     {"syncs", Json::array()}};
  // Names come from files and may not be valid UTF-8.
  file_.write(file.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
  file_.commit();
}

}  // namespace vestige
