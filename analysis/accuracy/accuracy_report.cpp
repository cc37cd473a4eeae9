#include "analysis/accuracy/accuracy_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "analysis/base/pareto.hpp"
#include "analysis/base/provenance.hpp"
#include "analysis/base/statistics.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

/// Intervals do not depend on the seed of the scenes.
constexpr std::uint64_t kResamplingSeed = 1;

double quantile_ms(const std::vector<double>& seconds, double p) {
  return quantile(seconds, p) * 1e3;
}

/// Milliseconds, or null if there is nothing to measure.
nlohmann::ordered_json quantiles_ms(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  return {{"median", quantile_ms(seconds, 0.5)}, {"p99", quantile_ms(seconds, 0.99)}, {"max", quantile_ms(seconds, 1)}};
}

/// A figure and its 95 % interval.
struct Estimate {
  double value = 0;
  Interval interval;
};

using Count = std::uint64_t (*)(const EventCounts&);

std::uint64_t wrong_of(const EventCounts& counts) {
  return counts.wrong();
}
std::uint64_t missed_of(const EventCounts& counts) {
  return counts.missed;
}
std::uint64_t false_of(const EventCounts& counts) {
  return counts.false_events;
}
std::uint64_t wrong_actuator_of(const EventCounts& counts) {
  return counts.wrong_actuator;
}

ClusterShare share_in(const EventCounts& counts, Count count) {
  return {static_cast<double>(count(counts)), static_cast<double>(counts.true_events())};
}

/// Returns a count for each true event. It is above 1 where more is false than true. NaN if there are no true events.
double share_of(const EventScore& score, Count count) {
  const ClusterShare all = share_in(score.all, count);
  return all.whole > 0 ? all.part / all.whole : kMissing;
}

/// As above, and how sure it is.
Estimate estimated_share(const EventScore& score, Count count) {
  std::vector<ClusterShare> clusters;
  clusters.reserve(score.of_collider.size());
  for (const EventCounts& counts : score.of_collider) clusters.push_back(share_in(counts, count));
  return {share_of(score, count), bootstrap_share(clusters, kResamplingSeed)};
}

nlohmann::ordered_json number(double value) {
  return std::isnan(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

nlohmann::ordered_json to_json(const Estimate& estimate) {
  return {{"value", number(estimate.value)},
          {"low", number(estimate.interval.low)},
          {"high", number(estimate.interval.high)}};
}

nlohmann::ordered_json counts_json(const EventScore& score) {
  const EventCounts& all = score.all;
  nlohmann::ordered_json json = {{"true_events", all.true_events()},
                                 {"found", all.found},
                                 {"mistaken", all.mistaken},
                                 {"missed", all.missed},
                                 {"missed_beside_another", all.missed_beside_another},
                                 {"test_events", all.test_events()},
                                 {"right", all.right},
                                 {"wrong_actuator", all.wrong_actuator},
                                 {"false_events", all.false_events}};
  const std::pair<const char*, Count> shares[] = {{"wrong_share", wrong_of},
                                                  {"missed_share", missed_of},
                                                  {"false_share", false_of},
                                                  {"wrong_actuator_share", wrong_actuator_of}};
  for (const auto& [name, count] : shares) json[name] = to_json(estimated_share(score, count));
  return json;
}

nlohmann::ordered_json to_json(const EventScore& score) {
  nlohmann::ordered_json json = counts_json(score);
  json["impact_error_ms"] = quantiles_ms(score.impact_error_s);
  json["onset_error_ms"] = quantiles_ms(score.onset_error_s);
  return json;
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
    if (const auto kept = contestants[i].instance->triangles_kept()) series["triangles_kept"] = *kept;
    describe(contestants[i], series);
    series["points"] = nlohmann::ordered_json::array();
    for (const AccuracyPoint& point : points)
      if (point.contestant == i) series["points"].push_back(point_json(point));
    list.push_back(std::move(series));
  }
  return list;
}

nlohmann::ordered_json truth_json(const AccuracyScene& scene, const std::string& detector) {
  nlohmann::ordered_json halved = {
      {"rate_hz", scene.truth_rate_hz / 2}, {"contacts", scene.half_contacts}, {"events", scene.half_events}};
  halved.update(to_json(scene.half_score));
  nlohmann::ordered_json json = {{"detector", detector},
                                 {"method", "ccd"},
                                 {"rate_hz", scene.truth_rate_hz},
                                 {"contacts", scene.true_contacts},
                                 {"events", scene.true_events},
                                 {"frames_checked_by_exact", scene.checked_frames},
                                 {"halved", halved}};
  if (scene.inside_s) json["inside_s"] = *scene.inside_s;
  return json;
}

nlohmann::ordered_json point_errors_json(const AccuracyPoint& point) {
  nlohmann::ordered_json json = {{"rate_hz", point.rate_hz}, {"frames", point.frames}, {"contacts", point.contacts}};
  json.update(to_json(point.score));
  json["within_tolerance"] = counts_json(point.tolerated);
  if (point.touches)
    json["touches"] = {{"frames_within", point.touches->within},
                       {"reported", point.touches->reported},
                       {"wrong_actuator", point.touches->wrong_actuator},
                       {"frames_outside", point.touches->outside},
                       {"false", point.touches->false_frames}};
  json["skinning_error_m"] = point.skinning.largest_m;
  return json;
}

/// Processor time in milliseconds for one second of the scene.
double load_ms(const AccuracyPoint& point) {
  return 1e3 * point.rate_hz / frequency_hz(point.processor_passes);
}

/// As above, and how sure it is: one pass does not tell. Seeds cost differently.
Estimate estimated_load_ms(const AccuracyPoint& point) {
  std::vector<Repetition> in_turn;  // the first pass of each seed, then the second of each
  in_turn.reserve(point.processor_passes.size());
  const std::size_t passes = point.processor_passes.size() / point.seeds;
  for (std::size_t pass = 0; pass < passes; ++pass)
    for (std::size_t seed = 0; seed < point.seeds; ++seed)
      in_turn.push_back(point.processor_passes[seed * passes + pass]);
  const Interval hz = bootstrap_frequency_hz(in_turn, point.seeds, kResamplingSeed);
  return {load_ms(point), {1e3 * point.rate_hz / hz.high, 1e3 * point.rate_hz / hz.low}};
}

/// Returns the indices of the points that no other beats in both processor time and errors within the tolerance, by
/// ascending time.
std::vector<std::size_t> front_of(const AccuracyScene& scene) {
  std::vector<Trade> trades;
  trades.reserve(scene.points.size());
  for (const AccuracyPoint& point : scene.points)
    trades.push_back({load_ms(point), share_of(point.tolerated, wrong_of)});
  return pareto_front(trades);
}

/// Names the points of the front.
nlohmann::ordered_json pareto_json(const AccuracyScene& scene, const std::vector<AccuracyContestant>& contestants) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const std::size_t i : front_of(scene)) {
    const AccuracyPoint& point = scene.points[i];
    const AccuracyContestant& contestant = contestants[point.contestant];
    list.push_back({{"detector", contestant.detector},
                    {"method", name_of(contestant.method)},
                    {"rate_hz", point.rate_hz},
                    {"processor_ms_per_s", load_ms(point)},
                    {"wrong_share", number(share_of(point.tolerated, wrong_of))}});
  }
  return list;
}

nlohmann::ordered_json point_times_json(const AccuracyPoint& point) {
  return {{"rate_hz", point.rate_hz},
          {"frames", point.frames},
          {"passes", point.passes.size() / point.seeds},
          {"hz", frequency_hz(point.passes)},
          {"us_median", quantile(point.frame_us, 0.5)},
          {"us_p99", quantile(point.frame_us, 0.99)},
          {"us_max", quantile(point.frame_us, 1)},
          {"processor_ms_per_s", to_json(estimated_load_ms(point))}};
}

/// "3.1 (1.0 to 5.2)", "< 0.8" if there are none.
std::string per_100_text(const EventScore& score) {
  const Estimate rate = estimated_share(score, wrong_of);
  if (std::isnan(rate.value)) return "-";
  if (score.all.wrong() == 0) return fmt::format("< {:.3g}", 100 * rate.interval.high);
  if (std::isnan(rate.interval.low)) return fmt::format("{:.1f}", 100 * rate.value);
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", 100 * rate.value, 100 * rate.interval.low, 100 * rate.interval.high);
}

/// "boxes, static (approx.)"
std::string title_of(const AccuracyContestant& contestant) {
  return fmt::format("{}, {}{}", contestant.detector, name_of(contestant.method),
                     contestant.instance->is_approximate() ? " (approx.)" : "");
}

/// What the events of spheres do not say: a touch may be found and still have holes.
std::string touch_table(const AccuracyScene& scene, const std::vector<AccuracyContestant>& contestants) {
  constexpr const char* kLine = "{:<26} {:>6} {:>14} {:>13} {:>8} {:>15} {:>13}\n";
  std::string table = fmt::format(kLine, "while a sphere touches", "rate", "frames within", "not reported", "wrong",
                                  "frames outside", "reported");
  fmt::format_to(std::back_inserter(table), kLine, "", "Hz", "a touch", "", "motor", "touches", "falsely");
  for (std::size_t i = 0; i < contestants.size(); ++i)
    for (const AccuracyPoint& point : scene.points)
      if (point.contestant == i)
        fmt::format_to(std::back_inserter(table), kLine, title_of(contestants[i]), point.rate_hz, point.touches->within,
                       point.touches->within - point.touches->reported, point.touches->wrong_actuator,
                       point.touches->outside, point.touches->false_frames);
  return table;
}

std::string scene_table(const AccuracyScene& scene, const std::vector<AccuracyContestant>& contestants,
                        double tolerance_s) {
  constexpr const char* kLine = "{:<26} {:>6} {:>6} {:>6} {:>6} {:>6}  {:>20} {:>20}  {:>13} {:>13}  {:>10}\n";
  std::string table =
      fmt::format(kLine, scene.colliders, "rate", "true", "missed", "false", "wrong", "wrong per 100 true",
                  fmt::format("within {:g} ms", tolerance_s * 1e3), "impact error", "onset error", "processor");
  fmt::format_to(std::back_inserter(table), kLine, "detector", "Hz", "events", "events", "events", "motor",
                 "95 % interval", "95 % interval", "median/p99 ms", "median/p99 ms", "ms a second");
  const std::vector<std::size_t> front = front_of(scene);
  const auto is_on_front = [&](const AccuracyPoint& point) {
    return std::ranges::find(front, static_cast<std::size_t>(&point - scene.points.data())) != front.end();
  };
  for (std::size_t i = 0; i < contestants.size(); ++i)
    for (const AccuracyPoint& point : scene.points) {
      if (point.contestant != i) continue;
      const auto pair_ms = [](const std::vector<double>& seconds) {
        return seconds.empty() ? std::string("-")
                               : fmt::format("{:.2f}/{:.2f}", quantile_ms(seconds, 0.5), quantile_ms(seconds, 0.99));
      };
      const EventCounts& all = point.score.all;
      fmt::format_to(std::back_inserter(table), kLine, title_of(contestants[i]), point.rate_hz, all.true_events(),
                     all.missed, all.false_events, all.wrong_actuator, per_100_text(point.score),
                     per_100_text(point.tolerated), pair_ms(point.score.impact_error_s),
                     pair_ms(point.score.onset_error_s),
                     fmt::format("{}{:.3g}", is_on_front(point) ? "* " : "", load_ms(point)));
    }
  if (!scene.points.empty() && scene.points.front().touches) table += touch_table(scene, contestants);
  const EventCounts& halved = scene.half_score.all;
  if (scene.inside_s && *scene.inside_s > 0)
    fmt::format_to(std::back_inserter(table), "Spheres are wholly inside the body for {:.2f} s, and touch nothing.\n",
                   *scene.inside_s);
  const std::string checked = scene.checked_frames == 0
                                  ? "no frame of them was checked"
                                  : fmt::format("exact agrees in all {} frames that it checked", scene.checked_frames);
  return table + fmt::format(
                     "*: nothing here is as cheap and has as few events wrong within the tolerance.\nTrue events: ccd "
                     "at {} Hz finds {} in {} of {:g} s; {}. At half the rate, ccd misses {} of them; {} of its events "
                     "are false, {} have another actuator.\n",
                     scene.truth_rate_hz, scene.true_events, counted(scene.seeds.size(), "seed"),
                     scene.duration_s / static_cast<double>(scene.seeds.size()), checked, halved.missed,
                     halved.false_events, halved.wrong_actuator);
}

}  // namespace

nlohmann::ordered_json errors_json(std::span<const AccuracyScene> scenes,
                                   const std::vector<AccuracyContestant>& contestants, const std::string& truth) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const AccuracyScene& scene : scenes)
    list.push_back({{"colliders", scene.colliders},
                    {"count", scene.collider_count},
                    {"seeds", scene.seeds},
                    {"duration_s", scene.duration_s},
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
    list.push_back({{"colliders", scene.colliders},
                    {"pareto", pareto_json(scene, contestants)},
                    {"series", series_json(scene.points, contestants, add_gl, point_times_json)}});
  return list;
}

std::string accuracy_table(std::span<const AccuracyScene> scenes, const std::vector<AccuracyContestant>& contestants,
                           double tolerance_s) {
  std::string table;
  for (const AccuracyScene& scene : scenes) {
    if (!table.empty()) table += '\n';
    table += scene_table(scene, contestants, tolerance_s);
  }
  return table;
}

}  // namespace vestige
