#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "analysis/plot/paraview/paraview_series.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

struct ParaviewOptions {
  std::string law = "binary";
  LawOptions law_options;
  double rate_hz = 60;                 ///< most steps a second, above 0
  std::size_t person = 0;              ///< whose skin is written, counted from 0
  std::optional<std::uint64_t> every;  ///< instead of a rate: one step every so many frames, at least 1
};

struct ParaviewResult {
  std::uint64_t frames = 0;
  std::uint64_t contacts = 0;
  bool interrupted = false;
};

/// Runs the trace through the CPU detector and the law, frame by frame, and passes steps to `series`. A step has all
/// contacts since the previous step, and the highest amplitude of each actuator, so nothing between two steps is lost.
/// The last frame is a step. Frames at the same time belong to one step. `progress` receives the share done and returns
/// false to stop. The steps written until then are complete. Throws `Error`.
ParaviewResult export_to_paraview(TraceReader& trace, const Subject& subject, const ParaviewOptions& options,
                                  ParaviewSeries& series, const std::function<bool(double)>& progress);

}  // namespace vestige::plot
