#include "analysis/claims/wording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "detector/gl/gl_context.hpp"

namespace vestige {

std::string in_words(std::uint64_t count) {
  constexpr std::uint64_t kMillion = 1'000'000;
  if (count < kMillion || count % kMillion != 0) return std::to_string(count);
  return fmt::format("{} million", count / kMillion);
}

std::string duration(double microseconds) {
  double value = microseconds;
  const char* unit = "µs";
  for (const char* larger : {"ms", "s"}) {
    if (value < 999.5) break;
    value /= 1000;
    unit = larger;
  }
  int decimals = 0;
  if (value < 99.95) decimals = value < 9.995 ? 2 : 1;
  return fmt::format("{:.{}f} {}", value, decimals, unit);
}

std::string on_renderer(const nlohmann::json& gl, ContextName context) {
  if (!gl.is_object() || gl.at("renderer").get<std::string>().empty()) return "";
  const auto name = gl["renderer"].get<std::string>();
  std::vector<std::string> notes;
  if (is_software_renderer(name)) notes.emplace_back("software");
  if (context == ContextName::kSaid && gl.contains("context")) notes.push_back(gl["context"].get<std::string>());
  // What stands in brackets in the name is said once, at the top of the page.
  const std::string text = " on " + name.substr(0, name.find(" ("));
  return notes.empty() ? text : fmt::format("{} ({})", text, fmt::join(notes, ", "));
}

std::string shared_context(const nlohmann::json& series) {
  std::set<std::string> contexts;
  for (const auto& one : series)
    if (one.at("gl").is_object()) contexts.insert(one["gl"].at("context").get<std::string>());
  return contexts.size() == 1 ? *contexts.begin() : "";
}

std::string approximate_words(const nlohmann::json& series) {
  if (!series.value("approximate", false)) return "";
  const auto kept = series.find("triangles_kept");
  if (kept == series.end() || !kept->is_number()) return " (approximate)";
  return fmt::format(" (approximate, {} triangles)", kept->get<std::uint64_t>());
}

nlohmann::json gl_used_by(const std::string& detector, const nlohmann::json& gl) {
  if (detector != "paper" && detector != "geometry" && detector != "compute") return {};
  if (gl.is_object()) return gl;
  return {{"renderer", "a renderer that the file does not name"}};
}

std::string listed(const std::vector<DetectorOnRenderer>& contestants) {
  std::vector<std::string> places;
  for (const auto& [name, place] : contestants)
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  std::ranges::stable_sort(places, [](const std::string& a, const std::string& b) { return !a.empty() && b.empty(); });
  std::string list;
  for (const std::string& place : places) {
    std::vector<std::string> names;
    for (const auto& [name, where] : contestants)
      if (where == place) names.push_back("`" + name + "`");
    if (!list.empty()) list += names.size() > 1 ? ", " : " and ";
    list += listed(names) + place;
  }
  return list;
}

std::string file_name(const nlohmann::json& path) {
  return "`" + std::filesystem::path(path.get<std::string>()).filename().string() + "`";
}

}  // namespace vestige
