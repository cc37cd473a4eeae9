#include "analysis/plot/data/skipping_data.hpp"

#include <optional>

#include "analysis/base/json_field.hpp"
#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

constexpr const char* kRemedy = "measure with 'vestige sweep --detector cpu --skip off,on'";
constexpr double kMost = 1e18;

/// The point with the most colliders of the first series of `cpu` with this setting.
std::optional<JsonField> last_point(const JsonField& series, const char* skip) {
  for (std::size_t i = 0; i < series.count(); ++i) {
    const JsonField one = series.at(i);
    if (one.at("detector").text() != "cpu" || !one.has("skip") || one.at("skip").text() != skip) continue;
    if (one.has("avatars") && one.at("avatars").within(1, kMost) > 1) one.refuse("is of several people");
    const JsonField points = one.at("points");
    std::size_t last = 0;
    for (std::size_t k = 1; k < points.count(); ++k)
      if (points.at(k).at("colliders").within(1, kMost) > points.at(last).at("colliders").within(1, kMost)) last = k;
    return points.at(last);
  }
  return {};
}

double us_of(const JsonField& point) {
  return 1e6 / point.at("hz").within(1e-6, 1e12);
}

SkippingGroup read_group(const std::filesystem::path& path) {
  const nlohmann::json json = read_json(path, kRemedy);
  const JsonField document(json, path, kRemedy);
  const JsonField series = document.at("series");
  const std::optional<JsonField> on = last_point(series, "on");
  if (!on) throw Error(path.string(), "does not measure cpu with skipping", kRemedy);
  SkippingGroup group;
  group.name = std::filesystem::path(document.at("trace").text()).stem().string();
  group.colliders = on->at("colliders").within(1, kMost);
  group.us = us_of(*on);
  const double part_pairs = on->at("part_pairs").within(0, kMost);
  const double spared = on->at("pairs_spared").within(0, part_pairs);
  const double frames = on->at("pass_frames").within(1, kMost);
  group.pairs.all = group.colliders * document.at("avatar").at("triangles").within(1, kMost);
  group.pairs.open = part_pairs > 0 ? group.pairs.all * (1 - spared / part_pairs) : 0;
  group.pairs.tested = on->at("pairs_tested").within(0, kMost) / frames;
  group.pairs.meeting = on->at("pairs_meeting").within(0, kMost) / frames;
  const std::optional<JsonField> off = last_point(series, "off");
  if (off && off->at("colliders").within(1, kMost) == group.colliders) group.us_off = us_of(*off);
  return group;
}

}  // namespace

SkippingResult read_skipping(const std::vector<std::filesystem::path>& paths) {
  SkippingResult result;
  result.source = read_sweeps({paths.front()}).sources.front();
  for (const std::filesystem::path& path : paths)
    result.groups.push_back(read_group(std::filesystem::is_directory(path) ? path / "sweep.json" : path));
  return result;
}

}  // namespace vestige::plot
