#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vestige::cli {

/// What `export` can turn a trace into.
struct ExportFormat {
  std::string_view name;               ///< as --format takes it
  std::vector<std::string_view> ends;  ///< what the names of such files end in
};

const std::vector<ExportFormat>& export_formats();

/// Throws `UsageError` if the name of the trace to be written ends as files of another kind do: .csv, .json, ….
void check_trace_name(const std::string& path);

}  // namespace vestige::cli
