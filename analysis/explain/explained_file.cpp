#include "analysis/explain/explained_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "analysis/explain/names_in_file.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr const char* kRemedy = "'vestige explain' without a file prints every kind of file and its names";

/// What a kind makes of a file's names.
ExplainedFile explain_as(const FileKind& kind, const NamesInFile& found) {
  ExplainedFile explained = {&kind, {}, {}};
  std::set<std::string> seen;
  for (const std::string& name : found.names) {
    PlacedField placed = find_field(kind, name);
    if (placed.field == nullptr) {
      if (!found.empty_ones.contains(name) || !holds_fields(kind, name)) explained.unexplained.push_back(name);
    } else if (seen.insert(placed.path).second) {
      explained.names.push_back(std::move(placed));
    }
  }
  return explained;
}

bool has_all(const NamesInFile& found, const std::vector<std::string>& names) {
  return std::ranges::all_of(
      names, [&](const std::string& name) { return std::ranges::find(found.names, name) != found.names.end(); });
}

/// How well a kind fits, the less the better: names that it does not have, and whether another verb writes it.
std::pair<std::size_t, bool> misfit(const ExplainedFile& explained, const NamesInFile& found) {
  return {explained.unexplained.size(), !explained.kind->written_by.starts_with("vestige " + found.verb)};
}

}  // namespace

ExplainedFile explain_file(const std::filesystem::path& path) {
  const NamesInFile found = names_in_file(path);
  ExplainedFile best;
  for (const FileKind& kind : file_kinds()) {
    if (kind.format != found.format || !has_all(found, required_names(kind))) continue;
    ExplainedFile explained = explain_as(kind, found);
    if (best.kind == nullptr || misfit(explained, found) < misfit(best, found)) best = std::move(explained);
  }
  if (found.names.empty()) throw Error(path.string(), "has no names", kRemedy);
  if (best.kind == nullptr || 2 * best.unexplained.size() >= found.names.size())
    throw Error(
        path == "-" ? "standard input" : path.string(),
        fmt::format("is no file that Vestige writes: its first names are {}",
                    fmt::join(std::span(found.names).first(std::min<std::size_t>(found.names.size(), 3)), ", ")),
        kRemedy);
  return best;
}

}  // namespace vestige
