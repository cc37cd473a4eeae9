#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"

namespace vestige::plot {

struct ReportOptions {
  std::filesystem::path output;  ///< where report.html and figures/ go
  std::size_t top = 12;          ///< maps that get pictures, best first; at least 1
  Overwrite overwrite = Overwrite::kRefuse;
};

struct ReportOutcome {
  std::filesystem::path page;
  std::size_t figures = 0;
  bool has_pictures = true;           ///< false: no OpenGL, so that there are no PNG files
  bool interrupted = false;           ///< then nothing was written
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Draws the folder that 'vestige batch -o' wrote: OUTPUT/report.html and OUTPUT/figures/*.svg, *.png. All of it or
/// nothing is written; equal folders give equal bytes. `progress` is told the share done and returns false to stop.
/// Throws `Error`: no batch's folder, a damaged file (naming file and field or line), files that exist already.
ReportOutcome write_report(const std::filesystem::path& batch, const ReportOptions& options,
                           const std::function<bool(double)>& progress);

}  // namespace vestige::plot
