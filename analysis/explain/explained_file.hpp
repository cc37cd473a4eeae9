#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/explain/file_kinds.hpp"

namespace vestige {

/// What the names in a file mean.
struct ExplainedFile {
  const FileKind* kind = nullptr;  ///< never null
  std::vector<PlacedField> names;  ///< in the order of the file, each once; a pattern once for all that it explains
  std::vector<std::string> unexplained;  ///< names that this kind of file does not have
};

/// Reads the names in a file ("-": text from standard input), and finds the kind that explains most of them, among
/// those whose required names it has. Of CSV, it reads the header only. Throws `Error` if the file cannot be read, or
/// if no kind explains more than half of its names.
ExplainedFile explain_file(const std::filesystem::path& path);

}  // namespace vestige
