#include "analysis/plot/data/growth_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "analysis/base/json_field.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a folder that 'vestige growth' wrote, or measure again";

/// What an axis can show; nothing real lies outside.
constexpr double kMostSize = 1e10;
constexpr double kMostFrame_s = 1e6;
constexpr double kLeastHz = 1e-6;
constexpr double kMostHz = 1e12;

GrowthLine read_line(const JsonField& series) {
  GrowthLine line;
  line.detector = series.at("detector").text();
  if (series.has("context")) line.context = series.at("context").text();
  line.skip = series.at("skip").text();
  return line;
}

double us_of(const JsonField& point) {
  return 1e6 / point.at("hz").within(kLeastHz, kMostHz);
}

/// Lines by their place in the file: every size lists the same series in the same order.
void add(GrowthPanel& panel, std::size_t index, const JsonField& series, const GrowthPoint& point) {
  if (panel.lines.size() <= index) panel.lines.resize(index + 1);
  GrowthLine& line = panel.lines[index];
  if (line.detector.empty()) line = read_line(series);
  line.points.push_back(point);
}

/// Adds a sentence about the series that were not measured at the largest sizes. Older files have no such list.
void add_left_out(const JsonField& document, const char* along, std::string& legend) {
  if (!document.has("left_out")) return;
  const JsonField all = document.at("left_out").at(along);
  if (all.value().empty()) return;
  legend += fmt::format(" Too slow for more {}:", along);
  for (std::size_t i = 0; i < all.count(); ++i)
    legend += fmt::format("{} '{}' above {:.0f} ({:.2g} s a frame)", i == 0 ? "" : ",", all.at(i).at("series").text(),
                          all.at(i).at("above").within(1, kMostSize), all.at(i).at("frame_s").within(0, kMostFrame_s));
  legend += ".";
}

void finish(GrowthPanel& panel) {
  std::erase_if(panel.lines, [](const GrowthLine& line) { return line.points.empty(); });
  for (GrowthLine& line : panel.lines) std::ranges::sort(line.points, {}, &GrowthPoint::size);
}

}  // namespace

GrowthResult read_growth(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "growth.json";
  const nlohmann::json json = read_json(path, kRemedy);
  const JsonField document(json, path, kRemedy);
  if (!json.is_object()) document.refuse("is not a JSON object");
  GrowthResult result;
  result.panels.resize(2);
  GrowthPanel& by_colliders = result.panels[0];
  GrowthPanel& by_triangles = result.panels[1];
  by_colliders.along = "Number of colliders";
  by_triangles.along = "Number of triangles";
  const JsonField all = document.at("by_colliders").at("series");
  for (std::size_t s = 0; s < all.count(); ++s) {
    const JsonField series = all.at(s);
    if (result.renderer.empty() && series.has("gl"))
      result.renderer = phrase(series.at("gl"), {{"renderer", ""}, {"version", ""}});
    const JsonField points = series.at("points");
    for (std::size_t p = 0; p < points.count(); ++p)
      add(by_colliders, s, series, {points.at(p).at("colliders").within(1, kMostSize), us_of(points.at(p))});
  }
  const JsonField sizes = document.at("by_triangles");
  if (sizes.value().is_array() && sizes.value().empty())
    throw Error(path.string(), "was stopped before another size of the avatar was measured",
                "run 'vestige growth' to its end");
  for (std::size_t i = 0; i < sizes.count(); ++i) {
    const double triangles = sizes.at(i).at("triangles").within(1, kMostSize);
    const JsonField series = sizes.at(i).at("series");
    for (std::size_t s = 0; s < series.count(); ++s) {
      const JsonField points = series.at(s).at("points");
      if (!points.value().empty()) add(by_triangles, s, series.at(s), {triangles, us_of(points.at(std::size_t{0}))});
    }
  }
  finish(by_colliders);
  finish(by_triangles);
  by_triangles.title = counted(static_cast<std::uint64_t>(document.at("colliders").within(1, kMostSize)), "collider");
  if (document.has("machine"))
    result.machine = phrase(document.at("machine"), {{"processor", ""}, {"cores", " cores"}});
  result.avatar = phrase(document.at("avatar"), {{"triangles", " triangles"}, {"vertices", " vertices"}});
  by_colliders.title = result.avatar;
  result.legend = "Triangles: those of the avatar, each split into four repeatedly.";
  add_left_out(document, "colliders", result.legend);
  add_left_out(document, "triangles", result.legend);
  result.commit = commit_of(document);
  return result;
}

}  // namespace vestige::plot
