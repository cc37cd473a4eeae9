#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// The trace that tells most about a map under a law: of those that are still there as they were judged, the one in
/// which the headline is worst, or, if the folder has no results of single traces, the one with the most contacts.
struct TellingTrace {
  const ReportTrace* trace = nullptr;  ///< null: none of the traces with contacts is there
  std::string file;
  std::optional<double> value;              ///< of the headline
  std::vector<std::string> not_there = {};  ///< names of the traces that would tell more
};

/// `batch` is the batch's folder. Traces are looked for where the batch was told to, and beside its folder.
TellingTrace telling_trace(const std::filesystem::path& batch, const ReportData& data, const Candidate& candidate);

/// Returns the page of 'vestige view' of this trace, with a candidate's map and law. Throws `Error` if the trace or the
/// map cannot be read; returns nothing if `progress` returned false.
std::optional<std::string> map_view(const std::filesystem::path& batch, const ReportData& data,
                                    const Candidate& candidate, const TellingTrace& telling,
                                    const std::function<bool(double)>& progress);

}  // namespace vestige::plot
