#include <fmt/format.h>

#include <map>

#include "analysis/claims/claims.hpp"
#include "analysis/claims/wording.hpp"

namespace vestige {

namespace {

std::string who(const nlohmann::json& series, ContextName context) {
  return fmt::format("`{}`{}{}", series.at("detector").get<std::string>(), on_renderer(series.at("gl"), context),
                     series.value("skip", "off") == "on" ? " with skipping" : "");
}

/// Returns the name that growth.json gives a series, as in "geometry, egl-surfaceless, skip on".
std::string label(const nlohmann::json& series) {
  const auto context = series.at("context").get<std::string>();
  return fmt::format("{}{}{}", series.at("detector").get<std::string>(), context.empty() ? "" : ", " + context,
                     series.value("skip", "off") == "on" ? ", skip on" : "");
}

std::string frame_time(const nlohmann::json& point) {
  return duration(1e6 / point.at("hz").get<double>());
}

/// Returns "… with 1 and … with 1000 colliders": the ends of a curve of times. Returns "" if it has no point.
std::string ends(std::vector<std::string> times, const std::string& unit) {
  if (times.empty()) return "";
  if (times.size() > 2) times.erase(times.begin() + 1, times.end() - 1);
  return listed(times) + " " + unit;
}

std::string by_colliders(const nlohmann::json& series) {
  std::vector<std::string> times;
  for (const auto& point : series.at("points"))
    times.push_back(fmt::format("{} with {}", frame_time(point), point.at("colliders").get<int>()));
  return ends(times, "colliders");
}

std::string by_triangles(const nlohmann::json& growth, const nlohmann::json& series) {
  std::vector<std::string> times;
  for (const auto& avatar : growth.at("by_triangles"))
    for (const auto& other : avatar.at("series"))
      if (label(other) == label(series) && !other.at("points").empty())
        times.push_back(fmt::format("{} with {}", frame_time(other["points"].front()),
                                    avatar.at("triangles").get<std::uint64_t>()));
  return ends(times, "triangles");
}

void add_growth(const nlohmann::json& growth, const std::string& file, std::vector<Claim>& claims) {
  const auto& all = growth.at("by_colliders").at("series");
  const std::string context = shared_context(all);
  std::vector<std::string> texts;
  std::map<std::string, std::string> names;
  for (const auto& series : all) {
    const std::string name = who(series, context.empty() ? ContextName::kSaid : ContextName::kLeftOut);
    names[label(series)] = name;
    const std::string colliders = by_colliders(series);
    const std::string triangles = by_triangles(growth, series);
    if (!colliders.empty() || !triangles.empty())
      texts.push_back(fmt::format("{}: {}{}{}", name, colliders, triangles.empty() ? "" : "; ", triangles));
  }
  std::vector<std::string> overtakings;
  for (const auto& crossover : growth.at("crossovers").at("colliders")) {
    const auto name = [&](const char* side) {
      const auto known = names.find(crossover.at(side).get<std::string>());
      return known == names.end() ? "`" + crossover[side].get<std::string>() + "`" : known->second;
    };
    overtakings.push_back(fmt::format("above {:.3g} colliders {} is faster than {}", crossover.at("at").get<double>(),
                                      name("cheaper_above"), name("cheaper_below")));
  }
  if (!overtakings.empty()) texts.push_back(fmt::format("Crossovers: {}", fmt::join(overtakings, "; ")));
  const std::string topic = fmt::format(
      "Mean time of a frame with more colliders (on {} triangles), and on more triangles (with {} colliders){}",
      growth.at("avatar").at("triangles").get<std::uint64_t>(), growth.at("colliders").get<int>(),
      context.empty() ? "" : ", " + context);
  for (const std::string& text : texts) claims.push_back({Question::kHowItScales, topic, text, {file}});
}

}  // namespace

std::vector<Claim> claims_how_it_scales(const std::vector<Result>& run) {
  std::vector<Claim> claims;
  for_each(ResultKind::kGrowth, run,
           [&](const nlohmann::json& growth, const std::string& file) { add_growth(growth, file, claims); });
  return claims;
}

}  // namespace vestige
