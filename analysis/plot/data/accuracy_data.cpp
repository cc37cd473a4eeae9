#include "analysis/plot/data/accuracy_data.hpp"

#include <algorithm>

#include "analysis/base/json_field.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a folder that 'vestige accuracy' wrote, or measure again";

/// What an axis can show; nothing real lies outside.
constexpr double kLeastRate_hz = 1e-3;
constexpr double kMostRate_hz = 1e9;
constexpr double kLeast_ms = 1e-6;
constexpr double kMost = 1e12;
constexpr double kMostEvents = 1e15;

/// `least` is above 0 for what a logarithmic axis shows. `unit` is what the figure counts in.
ValueRange read_estimate(const JsonField& field, double least, double unit) {
  const double value = field.at("value").within(least, kMost);
  const double low = field.has("low") ? std::min(field.at("low").within(least, kMost), value) : value;
  const double high = field.has("high") ? std::max(field.at("high").within(least, kMost), value) : value;
  return {value * unit, low * unit, high * unit};
}

AccuracyPoint read_point(const JsonField& errors, const JsonField& times) {
  AccuracyPoint point;
  point.rate_hz = errors.at("rate_hz").within(kLeastRate_hz, kMostRate_hz);
  if (times.at("rate_hz").within(kLeastRate_hz, kMostRate_hz) != point.rate_hz)
    times.at("rate_hz").refuse("differs from that of accuracy.json");
  point.load_ms = read_estimate(times.at("processor_ms_per_s"), kLeast_ms, 1);
  const JsonField within = errors.at("within_tolerance");
  point.wrong = read_estimate(within.at("wrong_share"), 0, 100);
  point.missed = read_estimate(within.at("missed_share"), 0, 100);
  point.false_events = read_estimate(within.at("false_share"), 0, 100);
  point.wrong_actuator = read_estimate(within.at("wrong_actuator_share"), 0, 100);
  return point;
}

/// The member of `times` that belongs to one of `errors`: both lists are in the same order.
JsonField partner(const JsonField& errors, const JsonField& times, std::size_t index,
                  std::initializer_list<const char*> keys) {
  if (times.count() != errors.count()) times.refuse("does not have as many entries as in accuracy.json");
  JsonField found = times.at(index);
  for (const char* key : keys)
    if (found.at(key).text() != errors.at(index).at(key).text())
      found.at(key).refuse("differs from that of accuracy.json");
  return found;
}

AccuracySeries read_series(const JsonField& errors, const JsonField& times) {
  AccuracySeries series;
  series.detector = errors.at("detector").text();
  series.method = errors.at("method").text();
  series.approximate = errors.at("approximate").flag();
  const JsonField points = errors.at("points");
  for (std::size_t i = 0; i < points.count(); ++i)
    series.points.push_back(read_point(points.at(i), partner(points, times.at("points"), i, {})));
  std::ranges::sort(series.points, {}, &AccuracyPoint::rate_hz);
  return series;
}

/// Marks the points that `pareto` names.
void mark_front(const JsonField& pareto, std::vector<AccuracySeries>& all) {
  for (std::size_t i = 0; i < pareto.count(); ++i) {
    const JsonField named = pareto.at(i);
    const std::string detector = named.at("detector").text();
    const std::string method = named.at("method").text();
    const double rate_hz = named.at("rate_hz").within(kLeastRate_hz, kMostRate_hz);
    for (AccuracySeries& series : all)
      for (AccuracyPoint& point : series.points)
        if (series.detector == detector && series.method == method && point.rate_hz == rate_hz) point.on_front = true;
  }
}

AccuracyPanel read_panel(const JsonField& errors, const JsonField& times) {
  AccuracyPanel panel;
  panel.colliders = errors.at("colliders").text();
  panel.collider_count = errors.at("count").within(0, kMostEvents);
  panel.true_events = errors.at("truth").at("events").within(0, kMostEvents);
  const JsonField series = errors.at("series");
  for (std::size_t i = 0; i < series.count(); ++i)
    panel.series.push_back(read_series(series.at(i), partner(series, times.at("series"), i, {"detector", "method"})));
  mark_front(times.at("pareto"), panel.series);
  return panel;
}

}  // namespace

AccuracyResult read_accuracy(const std::filesystem::path& folder) {
  const std::filesystem::path errors_path = folder / "accuracy.json";
  const std::filesystem::path run_path = folder / "run.json";
  const nlohmann::json errors_json = read_json(errors_path, kRemedy);
  const nlohmann::json run_json = read_json(run_path, kRemedy);
  const JsonField errors(errors_json, errors_path, kRemedy);
  const JsonField run(run_json, run_path, kRemedy);
  AccuracyResult result;
  const JsonField scenes = errors.at("scenes");
  for (std::size_t i = 0; i < scenes.count(); ++i) {
    const JsonField times = partner(scenes, run.at("scenes"), i, {"colliders"});
    result.panels.push_back(read_panel(scenes.at(i), times));
    if (result.panels.back().series.size() != result.panels.front().series.size())
      scenes.at(i).at("series").refuse("does not have as many entries as that of the first scene");
    for (std::size_t s = 0; result.renderer.empty() && s < times.at("series").count(); ++s)
      if (times.at("series").at(s).has("gl"))
        result.renderer = phrase(times.at("series").at(s).at("gl"), {{"renderer", ""}, {"version", ""}});
  }
  result.truth_rate_hz = scenes.at(std::size_t{0}).at("truth").at("rate_hz").within(kLeastRate_hz, kMostRate_hz);
  result.tolerance_ms = errors.at("tolerance_ms").within(0, kMost);
  if (errors.has("keep")) result.keep = errors.at("keep").within(0, 1);
  result.animation = errors.at("animation").text();
  result.avatar = phrase(errors.at("avatar"), {{"triangles", " triangles"}});
  if (run.has("machine")) result.machine = phrase(run.at("machine"), {{"processor", ""}, {"cores", " cores"}});
  result.commit = commit_of(run);
  return result;
}

}  // namespace vestige::plot
