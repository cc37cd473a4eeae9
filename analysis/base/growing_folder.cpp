#include "analysis/base/growing_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"

namespace vestige {

namespace fs = std::filesystem;

GrowingFolder::GrowingFolder(fs::path folder, Overwrite overwrite)
    : folder_(std::move(folder)),
      growing_(folder_.parent_path() / fmt::format(".{}.{}", folder_.filename().string(), ::getpid())) {
  if (fs::exists(folder_)) {
    if (!fs::is_directory(folder_)) throw Error(folder_.string(), "is not a folder", "choose another name");
    if (overwrite == Overwrite::kRefuse && !fs::is_empty(folder_))
      throw Error(folder_.string(), "already exists and contains files",
                  "choose another name, or add --force to overwrite them");
  }
  std::error_code failure;
  fs::create_directory(growing_, failure);
  if (failure) throw system_error(growing_, "could not create", failure.value());
}

GrowingFolder::~GrowingFolder() {
  std::error_code ignored;
  fs::remove_all(growing_, ignored);
}

void GrowingFolder::commit(const std::function<bool(const fs::path&)>& is_stale) {
  std::error_code failure;
  if (!fs::exists(folder_)) {
    fs::rename(growing_, folder_, failure);
    if (failure) throw system_error(folder_, "could not create", failure.value());
    return;
  }
  for (const auto& entry : fs::directory_iterator(folder_))
    if (is_stale(entry.path())) fs::remove(entry.path(), failure);
  for (const auto& entry : fs::directory_iterator(growing_)) {
    fs::rename(entry.path(), folder_ / entry.path().filename(), failure);
    if (failure) throw system_error(folder_ / entry.path().filename(), "could not replace", failure.value());
  }
}

}  // namespace vestige
