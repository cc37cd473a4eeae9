#pragma once

#include <filesystem>
#include <string_view>

namespace vestige {

/// Throws `Error` with this remedy if `folder` is not there or is not a folder.
void require_folder(const std::filesystem::path& folder, std::string_view remedy);

/// Throws `Error` if `folder` holds results of another verb than `verb`. The verbs are "batch", "accuracy" and
/// "stress": each writes a run.json, which the other's would replace.
void refuse_other_results(const std::filesystem::path& folder, std::string_view verb);

}  // namespace vestige
