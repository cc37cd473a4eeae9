#include "analysis/accuracy/accuracy_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "analysis/base/provenance.hpp"
#include "analysis/base/statistics.hpp"

namespace vestige {

namespace {

double quantile_ms(const std::vector<double>& seconds, double p) {
  return quantile(seconds, p) * 1e3;
}

/// Milliseconds, or null if there is nothing to measure.
nlohmann::ordered_json quantiles_ms(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  return {{"median", quantile_ms(seconds, 0.5)}, {"p99", quantile_ms(seconds, 0.99)}, {"max", quantile_ms(seconds, 1)}};
}

nlohmann::ordered_json to_json(const EventScore& score) {
  return {{"true_events", score.true_events()},
          {"found", score.found},
          {"mistaken", score.mistaken},
          {"missed", score.missed},
          {"missed_beside_another", score.missed_beside_another},
          {"missed_share", score.missed_share()},
          {"test_events", score.test_events()},
          {"right", score.right},
          {"wrong_actuator", score.wrong_actuator},
          {"false_events", score.false_events},
          {"impact_error_ms", quantiles_ms(score.impact_error_s)},
          {"onset_error_ms", quantiles_ms(score.onset_error_s)}};
}

EventScore score_of_half(const AccuracyScene& scene) {
  const TrueContacts& truth = scene.truth;
  const TrueContacts& half = scene.half;
  const double until_s =
      truth.events.empty() ? 0 : std::ranges::max(truth.events, {}, &ContactEvent::impact_s).impact_s;
  return score_events(truth.events, half.events, 1 / half.rate_hz, until_s);
}

/// Contestants with their points.
nlohmann::ordered_json series_json(
    std::span<const AccuracyPoint> points, const std::vector<AccuracyContestant>& contestants,
    const std::function<void(const AccuracyContestant&, nlohmann::ordered_json&)>& describe,
    const std::function<nlohmann::ordered_json(const AccuracyPoint&)>& point_json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    nlohmann::ordered_json series = {{"detector", contestants[i].detector},
                                     {"approximate", contestants[i].instance->is_approximate()},
                                     {"method", name_of(contestants[i].method)}};
    describe(contestants[i], series);
    series["points"] = nlohmann::ordered_json::array();
    for (const AccuracyPoint& point : points)
      if (point.contestant == i) series["points"].push_back(point_json(point));
    list.push_back(std::move(series));
  }
  return list;
}

nlohmann::ordered_json truth_json(const AccuracyScene& scene, const std::string& detector) {
  const TrueContacts& truth = scene.truth;
  const TrueContacts& half = scene.half;
  nlohmann::ordered_json halved = {
      {"rate_hz", half.rate_hz}, {"contacts", half.contacts}, {"events", half.events.size()}};
  halved.update(to_json(score_of_half(scene)));
  return {{"detector", detector},          {"method", "ccd"}, {"rate_hz", truth.rate_hz}, {"contacts", truth.contacts},
          {"events", truth.events.size()}, {"halved", halved}};
}

nlohmann::ordered_json point_errors_json(const AccuracyPoint& point) {
  nlohmann::ordered_json json = {{"rate_hz", point.rate_hz}, {"frames", point.frames}, {"contacts", point.contacts}};
  json.update(to_json(point.score));
  json["skinning_error_m"] = point.skinning.largest_m;
  return json;
}

nlohmann::ordered_json point_times_json(const AccuracyPoint& point) {
  return {{"rate_hz", point.rate_hz},
          {"frames", point.frames},
          {"hz", static_cast<double>(point.frames) / point.total_s()},
          {"us_median", quantile(point.frame_us, 0.5)},
          {"us_p99", quantile(point.frame_us, 0.99)},
          {"us_max", quantile(point.frame_us, 1)}};
}

std::string scene_table(const AccuracyScene& scene, const std::vector<AccuracyContestant>& contestants) {
  std::string table = fmt::format("{:<23} {:>7} {:>6} {:>6} {:>7} {:>8} {:>6} {:>6}  {:>15}  {:>15}  {:>17}\n",
                                  scene.colliders, "rate", "true", "missed", "missed", "mistaken", "wrong", "false",
                                  "impact error", "onset error", "time a frame");
  fmt::format_to(std::back_inserter(table),
                 "{:<23} {:>7} {:>6} {:>6} {:>7} {:>8} {:>6} {:>6}  {:>15}  {:>15}  {:>17}\n", "detector", "Hz",
                 "events", "events", "%", "events", "motor", "events", "median/p99 ms", "median/p99 ms",
                 "median/p99 us");
  for (std::size_t i = 0; i < contestants.size(); ++i)
    for (const AccuracyPoint& point : scene.points) {
      if (point.contestant != i) continue;
      const EventScore& score = point.score;
      const auto pair_ms = [](const std::vector<double>& seconds) {
        return seconds.empty() ? std::string("-")
                               : fmt::format("{:.3f}/{:.3f}", quantile_ms(seconds, 0.5), quantile_ms(seconds, 0.99));
      };
      fmt::format_to(
          std::back_inserter(table), "{:<23} {:>7} {:>6} {:>6} {:>7.2f} {:>8} {:>6} {:>6}  {:>15}  {:>15}  {:>17}\n",
          fmt::format("{}, {}{}", contestants[i].detector, name_of(contestants[i].method),
                      contestants[i].instance->is_approximate() ? " (approximate)" : ""),
          point.rate_hz, score.true_events(), score.missed, 100 * score.missed_share(), score.mistaken,
          score.wrong_actuator, score.false_events, pair_ms(score.impact_error_s), pair_ms(score.onset_error_s),
          fmt::format("{:.0f}/{:.0f}", quantile(point.frame_us, 0.5), quantile(point.frame_us, 0.99)));
    }
  const EventScore halved = score_of_half(scene);
  return table + fmt::format(
                     "True events: ccd at {} Hz finds {}. At {} Hz, ccd misses {} of them and mistakes {}; {} of its "
                     "events are false, {} have another actuator.\n",
                     scene.truth.rate_hz, scene.truth.events.size(), scene.half.rate_hz, halved.missed, halved.mistaken,
                     halved.false_events, halved.wrong_actuator);
}

}  // namespace

nlohmann::ordered_json errors_json(std::span<const AccuracyScene> scenes,
                                   const std::vector<AccuracyContestant>& contestants, const std::string& truth) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AccuracyScene& scene : scenes)
    list.push_back({{"colliders", scene.colliders},
                    {"count", scene.collider_count},
                    {"truth", truth_json(scene, truth)},
                    {"series", series_json(
                                   scene.points, contestants, [](const AccuracyContestant&, nlohmann::ordered_json&) {},
                                   point_errors_json)}});
  return list;
}

nlohmann::ordered_json times_json(std::span<const AccuracyScene> scenes,
                                  const std::vector<AccuracyContestant>& contestants) {
  const auto add_gl = [](const AccuracyContestant& contestant, nlohmann::ordered_json& series) {
    series["gl"] = to_json(contestant.instance->gl_info());
  };
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AccuracyScene& scene : scenes)
    list.push_back(
        {{"colliders", scene.colliders}, {"series", series_json(scene.points, contestants, add_gl, point_times_json)}});
  return list;
}

std::string accuracy_table(std::span<const AccuracyScene> scenes, const std::vector<AccuracyContestant>& contestants) {
  std::string table;
  for (const AccuracyScene& scene : scenes) {
    if (!table.empty()) table += '\n';
    table += scene_table(scene, contestants);
  }
  return table;
}

}  // namespace vestige
