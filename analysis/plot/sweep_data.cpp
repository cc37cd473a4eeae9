#include "analysis/plot/sweep_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "traces/error.hpp"
#include "traces/input_file.hpp"

namespace vestige::plot {

namespace {

using Json = nlohmann::json;

constexpr std::string_view kRemedy = "was it written by 'vestige sweep'? Measure again, or name another file";

/// A value and the way to it, for messages.
struct Field {
  const Json& value;
  std::string name;
  const std::filesystem::path& file;

  [[noreturn]] void refuse(std::string_view cause) const {
    throw Error(file.string(), fmt::format("{} {}", name.empty() ? "the document" : name, cause), kRemedy);
  }
  bool has(const char* key) const { return value.is_object() && value.contains(key) && !value.at(key).is_null(); }
  Field at(const char* key) const {
    const std::string full = name.empty() ? key : fmt::format("{}.{}", name, key);
    if (!value.is_object() || !value.contains(key))
      throw Error(file.string(), fmt::format("the field {} is missing", full), kRemedy);
    return {value.at(key), full, file};
  }
  Field at(std::size_t index) const { return {value.at(index), fmt::format("{}[{}]", name, index), file}; }
  std::size_t count() const {
    if (!value.is_array()) refuse("is no list");
    if (value.empty()) refuse("is empty");
    return value.size();
  }
  double within(double least, double most) const {
    if (!value.is_number()) refuse("is no number");
    const double number = value.get<double>();
    if (!(number >= least && number <= most)) refuse(fmt::format("is {}, not within {} and {}", number, least, most));
    return number;
  }
  std::string text() const {
    if (!value.is_string()) refuse("is no text");
    return value.get<std::string>();
  }
  /// "on" and "off" may also be true and false.
  std::string setting() const {
    if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
    return text();
  }
};

/// What an axis can show; nothing real lies outside.
constexpr double kMostColliders = 1e9;
constexpr double kLeastHz = 1e-6;
constexpr double kMostHz = 1e12;

SweepPoint read_point(const Field& field) {
  SweepPoint point;
  point.colliders = field.at("colliders").within(1, kMostColliders);
  point.hz = field.at("hz").within(kLeastHz, kMostHz);
  if (field.has("hz_low") && field.has("hz_high")) {
    point.hz_low = field.at("hz_low").within(kLeastHz, kMostHz);
    point.hz_high = field.at("hz_high").within(*point.hz_low, kMostHz);
  }
  return point;
}

SweepSeries read_series(const Field& field) {
  SweepSeries series;
  series.detector = field.at("detector").text();
  if (series.detector.empty()) field.at("detector").refuse("is empty");
  if (field.has("context")) series.context = field.at("context").text();
  if (series.context == "none") series.context.clear();
  if (field.has("skip")) series.skip = field.at("skip").setting();
  if (field.has("method")) series.method = field.at("method").text();
  const Field points = field.at("points");
  for (std::size_t i = 0; i < points.count(); ++i) series.points.push_back(read_point(points.at(i)));
  std::ranges::sort(series.points, {}, &SweepPoint::colliders);
  const auto twice = std::ranges::adjacent_find(series.points, {}, &SweepPoint::colliders);
  if (twice != series.points.end()) points.refuse(fmt::format("has {} colliders twice", twice->colliders));
  return series;
}

/// The texts and numbers of `field`'s members `keys`, where they are there, with their words.
std::string phrase(const Field& field, std::initializer_list<std::pair<const char*, const char*>> keys) {
  std::string result;
  for (const auto& [key, words] : keys) {
    if (!field.has(key)) continue;
    const Json& value = field.value.at(key);
    if (!value.is_string() && !value.is_number()) continue;
    const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    if (shown.empty()) continue;
    if (!result.empty()) result += ", ";
    result += shown + words;
  }
  return result;
}

SweepSource read_source(const Field& document) {
  SweepSource source;
  if (document.has("gl")) source.renderer = phrase(document.at("gl"), {{"renderer", ""}, {"version", ""}});
  if (document.has("machine"))
    source.machine = phrase(document.at("machine"), {{"processor", ""}, {"cores", " cores"}});
  if (document.has("avatar"))
    source.avatar = phrase(document.at("avatar"), {{"triangles", " triangles"}, {"vertices", " vertices"}});
  source.commit = document.at("commit").text().substr(0, 10);
  if (document.has("dirty") && document.at("dirty").value == true) source.commit += " (changed)";
  return source;
}

void read_sweep(const std::filesystem::path& path, Sweeps& sweeps) {
  Json json;
  try {
    json = Json::parse(read_text_file(path));
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format("{}, byte {}", path.string(), error.byte), "is no JSON", kRemedy);
  }
  const Field document{json, "", path};
  if (!json.is_object()) document.refuse("is no JSON object");
  const Field series = document.at("series");
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
