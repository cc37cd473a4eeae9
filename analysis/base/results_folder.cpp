#include "analysis/base/results_folder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// What each verb alone writes beside its run.json.
constexpr std::pair<std::string_view, const char*> kWrites[] = {
    {"batch", "items"}, {"accuracy", "accuracy.json"}, {"stress", "stress.json"}};

}  // namespace

void require_folder(const std::filesystem::path& folder, std::string_view remedy) {
  if (std::filesystem::is_directory(folder)) return;
  throw Error(folder.string(), std::filesystem::exists(folder) ? "is not a folder" : "there is no such folder", remedy);
}

void refuse_other_results(const std::filesystem::path& folder, std::string_view verb) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "run.json", ignored)) return;
  for (const auto& [other, file] : kWrites)
    if (other != verb && std::filesystem::exists(folder / file, ignored))
      throw Error(folder.string(), fmt::format("holds results of 'vestige {}': run.json and {}", other, file),
                  "name another folder with -o");
}

}  // namespace vestige
