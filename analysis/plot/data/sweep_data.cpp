#include "analysis/plot/data/sweep_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/base/json_field.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a file that 'vestige sweep' wrote, or measure again";

/// "on" and "off" may also be true and false.
std::string setting(const JsonField& field) {
  if (field.value().is_boolean()) return field.value().get<bool>() ? "on" : "off";
  return field.text();
}

/// What an axis can show; nothing real lies outside.
constexpr double kMostColliders = 1e9;
constexpr double kMostPlanes = 16;
constexpr double kMostPeople = 1e4;
constexpr double kLeastHz = 1e-6;
constexpr double kMostHz = 1e12;
constexpr double kMostUs = 1e12;

SweepStages read_stages(const JsonField& field) {
  SweepStages stages;
  if (!field.value().is_object()) field.refuse("is not a JSON object");
  double total_us = 0;
  for (const auto& [name, ignored] : field.value().items()) {
    const auto known = std::ranges::find(kStageNames, std::string_view(name));
    if (known == kStageNames.end()) field.refuse(fmt::format("has a stage '{}', which is unknown", name));
    const double us = field.at(name.c_str()).within(0, kMostUs);
    stages.us[static_cast<std::size_t>(known - kStageNames.begin())] = us;
    total_us += us;
  }
  if (!(total_us > 0)) field.refuse("has no stage that took time");
  return stages;
}

SweepPoint read_point(const JsonField& field) {
  SweepPoint point;
  point.colliders = field.at("colliders").within(1, kMostColliders);
  point.hz = field.at("hz").within(kLeastHz, kMostHz);
  if (field.has("hz_low") && field.has("hz_high")) {
    point.hz_low = field.at("hz_low").within(kLeastHz, kMostHz);
    point.hz_high = field.at("hz_high").within(*point.hz_low, kMostHz);
  }
  if (!field.has("stages")) return point;
  point.stages = read_stages(field.at("stages"));
  point.stages->drawn_by_timer = field.has("draw_by") && field.at("draw_by").text() == "timer";
  return point;
}

SweepSeries read_series(const JsonField& field) {
  SweepSeries series;
  series.detector = field.at("detector").text();
  if (series.detector.empty()) field.at("detector").refuse("is empty");
  if (field.has("context")) series.context = field.at("context").text();
  if (series.context == "none") series.context.clear();
  if (field.has("skip")) series.skip = setting(field.at("skip"));
  if (field.has("method")) series.method = field.at("method").text();
  if (field.has("renderer")) series.renderer = setting(field.at("renderer"));
  if (field.has("approximate")) series.approximate = field.at("approximate").flag();
  if (field.has("planes")) series.planes = field.at("planes").within(1, kMostPlanes);
  if (field.has("avatars")) series.people = field.at("avatars").within(1, kMostPeople);
  if (field.has("colliders_around")) series.first_only = field.at("colliders_around").text() == "first";
  const JsonField points = field.at("points");
  for (std::size_t i = 0; i < points.count(); ++i) series.points.push_back(read_point(points.at(i)));
  std::ranges::sort(series.points, {}, &SweepPoint::colliders);
  const auto twice = std::ranges::adjacent_find(series.points, {}, &SweepPoint::colliders);
  if (twice != series.points.end()) points.refuse(fmt::format("has {} colliders twice", twice->colliders));
  return series;
}

SweepSource read_source(const JsonField& document) {
  SweepSource source;
  if (document.has("gl")) source.renderer = phrase(document.at("gl"), {{"renderer", ""}, {"version", ""}});
  if (document.has("machine"))
    source.machine = phrase(document.at("machine"), {{"processor", ""}, {"cores", " cores"}});
  if (document.has("avatar"))
    source.avatar = phrase(document.at("avatar"), {{"triangles", " triangles"}, {"vertices", " vertices"}});
  source.commit = commit_of(document);
  if (document.has("surface")) source.surface = document.at("surface").text();
  if (document.has("complete")) source.complete = setting(document.at("complete")) == "on";
  return source;
}

void read_sweep(const std::filesystem::path& path, Sweeps& sweeps) {
  const nlohmann::json json = read_json(path, kRemedy);
  const JsonField document(json, path, kRemedy);
  if (!json.is_object()) document.refuse("is not a JSON object");
  const JsonField series = document.at("series");
  for (std::size_t i = 0; i < series.count(); ++i) {
    sweeps.series.push_back(read_series(series.at(i)));
    sweeps.series.back().sweep = sweeps.sources.size();
  }
  sweeps.sources.push_back(read_source(document));
}

}  // namespace

Sweeps read_sweeps(const std::vector<std::filesystem::path>& paths) {
  Sweeps sweeps;
  for (const auto& path : paths) read_sweep(std::filesystem::is_directory(path) ? path / "sweep.json" : path, sweeps);
  return sweeps;
}

}  // namespace vestige::plot
