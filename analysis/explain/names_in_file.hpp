#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "analysis/explain/file_kinds.hpp"

namespace vestige {

/// The names in a file.
struct NamesInFile {
  FileFormat format = FileFormat::kCsv;
  /// Columns, channels, tables, or paths of JSON ("machine/cores": no brackets for lists), each once, in order.
  std::vector<std::string> names;
  std::set<std::string> empty_ones;  ///< those that are null, an empty list or an empty object
  std::string verb;                  ///< of JSON: the verb that wrote it, as its "argv" says; empty: it does not say
};

/// Reads them; of CSV from the header only, of lines of JSON from the first thousand. `path` may be "-" for text.
/// Throws `Error` if the file cannot be read or is of no such format.
NamesInFile names_in_file(const std::filesystem::path& path);

}  // namespace vestige
