#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"

namespace vestige::plot {

struct ReportOptions {
  std::filesystem::path output;  ///< folder for report.html and figures/
  std::size_t top = 12;          ///< number of maps that get pictures, best first; at least 1
  Overwrite overwrite = Overwrite::kRefuse;
};

struct ReportOutcome {
  std::filesystem::path page;
  std::size_t figures = 0;
  bool has_pictures = true;           ///< false: without OpenGL, PNG files were not written
  bool interrupted = false;           ///< true: nothing was written
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Draws a folder that 'vestige batch -o' wrote. Writes OUTPUT/report.html and OUTPUT/figures/*.svg, *.png, either all
/// of them or nothing. Equal folders give equal bytes. `progress` receives the share done and returns false to stop.
/// Throws `Error` if the folder holds no batch, if a file is damaged (with file and field or line), or if files exist
/// already.
ReportOutcome write_report(const std::filesystem::path& batch, const ReportOptions& options,
                           const std::function<bool(double)>& progress);

}  // namespace vestige::plot
