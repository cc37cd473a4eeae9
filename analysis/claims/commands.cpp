#include "analysis/claims/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <span>

#include "detector/gl/gl_context.hpp"

namespace vestige {

namespace {

using Words = std::vector<std::string>;

bool is_boundary(const std::string& word, std::size_t at) {
  const auto letter = [&word](std::size_t i) { return std::isalnum(static_cast<unsigned char>(word[i])) != 0; };
  return at == 0 || at == word.size() || !letter(at - 1) || !letter(at);
}

std::string renderer_name(const nlohmann::json& gl) {
  const auto name = gl.at("renderer").get<std::string>();
  return is_software_renderer(name) ? name + ", **software**" : name;
}

/// Adds the renderers of all `gl` objects below `json`.
void add_renderers(const nlohmann::json& json, std::set<std::string>& names) {
  if (!json.is_structured()) return;
  if (json.is_object())
    for (const char* field : {"gl", "renderer_gl"})
      if (json.contains(field) && json[field].is_object()) names.insert(renderer_name(json[field]));
  if (json.is_object() && json.contains("methods"))
    for (const auto& method : json["methods"])
      if (method.value("renderer", "") != "") names.insert(renderer_name(method));
  for (const auto& below : json) add_renderers(below, names);
}

Words words_of(const nlohmann::json& argv) {
  auto words = argv.get<Words>();
  if (!words.empty()) words[0] = std::filesystem::path(words[0]).filename().string();
  return words;
}

/// Returns the length of the part that all words share, up to its last '/'.
std::size_t shared_folder(std::span<const std::string> words) {
  std::size_t length = words[0].size();
  for (const std::string& word : words)
    length = std::min(length, static_cast<std::size_t>(std::ranges::mismatch(words[0], word).in1 - words[0].begin()));
  const std::size_t slash = words[0].substr(0, length).rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

/// Returns the words as one command. Three or more files of one folder and type in a row stand in braces.
std::string joined(const Words& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size();) {
    const auto type = [&words](std::size_t at) { return std::filesystem::path(words[at]).extension().string(); };
    std::size_t end = i + 1;
    while (end < words.size() && !type(i).empty() && type(end) == type(i) &&
           shared_folder(std::span(words).subspan(i, end + 1 - i)) > 0)
      ++end;
    if (!text.empty()) text += " ";
    if (end - i < 3) {
      text += words[i++];
      continue;
    }
    const std::size_t folder = shared_folder(std::span(words).subspan(i, end - i));
    Words names;
    for (std::size_t at = i; at < end; ++at)
      names.push_back(words[at].substr(folder, words[at].size() - folder - type(at).size()));
    text += fmt::format("{}{{{}}}{}", words[i].substr(0, folder), fmt::join(names, ","), type(i));
    i = end;
  }
  return text;
}

/// Commands that differ in one name or number, wherever it stands in them.
struct Group {
  std::vector<Words> commands;
  std::vector<std::string> files;
  std::string origin;                                         ///< machine, renderer and commit
  std::vector<std::pair<std::size_t, std::size_t>> places{};  ///< word and character where the name stands
  std::vector<std::string> names{};                           ///< one for each command; none with one command
};

/// Adds the command to the group if it differs from the others in one name only.
bool add_to(Group& group, const Words& words, const std::string& origin, const std::string& file) {
  const Words& first = group.commands.front();
  if (group.origin != origin || first.size() != words.size()) return false;
  std::vector<std::pair<std::size_t, std::size_t>> places;
  Difference names;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == first[i]) continue;
    const Difference here = difference(first[i], words[i]);
    if (!places.empty() && (here.of_first != names.of_first || here.of_second != names.of_second)) return false;
    names = here;
    places.emplace_back(i, here.begin);
  }
  if (names.of_first.empty()) return false;
  if (!group.names.empty() && (group.places != places || group.names[0] != names.of_first)) return false;
  if (group.names.empty()) group.names.push_back(names.of_first);
  group.places = places;
  group.names.push_back(names.of_second);
  group.commands.push_back(words);
  group.files.push_back(file);
  return true;
}

std::string text_of(const Group& group) {
  Words words = group.commands.front();
  for (const auto& [word, begin] : group.places)
    words[word].replace(begin, group.names[0].size(), fmt::format("<{}>", fmt::join(group.names, "|")));
  return joined(words);
}

}  // namespace

Difference difference(const std::string& first, const std::string& second) {
  auto begin = static_cast<std::size_t>(std::ranges::mismatch(first, second).in1 - first.begin());
  while (!is_boundary(first, begin) || !is_boundary(second, begin)) --begin;
  const std::size_t longest = std::min(first.size(), second.size()) - begin;
  std::size_t end = 0;
  while (end < longest && first[first.size() - 1 - end] == second[second.size() - 1 - end]) ++end;
  while (!is_boundary(first, first.size() - end) || !is_boundary(second, second.size() - end)) --end;
  if (first.size() == begin + end || second.size() == begin + end) return {};
  return {begin, first.substr(begin, first.size() - begin - end), second.substr(begin, second.size() - begin - end)};
}

Origin origin_of(const Result& result) try {
  const nlohmann::json& json = result.json;
  std::set<std::string> renderers;
  add_renderers(json, renderers);
  const auto& machine = json.at("machine");
  return {joined(words_of(json.at("argv"))), json.at("time").get<std::string>(),
          fmt::format("{}, {} cores", machine.at("processor").get<std::string>(), machine.at("cores").get<int>()),
          renderers.empty() ? "no GL" : fmt::format("{}", fmt::join(renderers, "; ")),
          fmt::format("{:.10}{}", json.at("commit").get<std::string>(), json.at("dirty").get<bool>() ? "+" : "")};
} catch (const nlohmann::json::exception& exception) {
  throw not_ours(result.path, exception);
}

std::vector<Command> commands_of(const std::vector<Result>& run) {
  std::vector<Group> groups;
  for (const Result& result : run) {
    const Origin origin = origin_of(result);
    const std::string key = origin.machine + origin.renderer + origin.commit;
    const Words words = words_of(result.json.at("argv"));
    if (std::ranges::none_of(groups, [&](Group& group) { return add_to(group, words, key, result.file); }))
      groups.push_back({{words}, {result.file}, key});
  }
  std::vector<Command> commands;
  commands.reserve(groups.size());
  for (const Group& group : groups) commands.push_back({text_of(group), group.files});
  return commands;
}

}  // namespace vestige
