#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "analysis/compare/pass_time.hpp"

namespace vestige {

/// One point of a sweep.
struct MeasuredPoint {
  std::string name;  ///< unique within its sweep: "cpu, skip on, 40 colliders"
  double hz = 0;     ///< frames over total time
  std::uint64_t pass_frames = 0;
  PassTime time;
  std::string renderer;  ///< of OpenGL; empty for a detector without it
  std::string driver;    ///< OpenGL's version; empty for a detector without it
  std::uint64_t contacts = 0;
  std::string texture_hash;

  /// The frequency as far as other programs did not disturb it. Never below `hz` by more than noise.
  double typical_hz() const { return 1e6 * static_cast<double>(pass_frames) / time.us; }
};

/// What one sweep.json and the frame times beside it say.
struct MeasuredSweep {
  std::filesystem::path file;        ///< sweep.json
  std::filesystem::path times_file;  ///< the durations beside it
  std::string place;                 ///< its folder, relative to the result folder; empty for the folder itself
  std::uint64_t schema_version = 0;
  std::string commit;  ///< shortened, with " (changed)" if files had been changed since
  std::string time;    ///< UTC
  std::string processor;
  std::uint64_t cores = 0;
  std::string system;
  /// What was asked, as names and JSON: avatar, surface, runs, run_frames, seed (which draws
  /// colliders). Absent fields are left out.
  std::vector<std::pair<std::string, std::string>> question;
  std::vector<MeasuredPoint> points;
};

/// Reads every sweep in `folder` and below, sorted by place. Throws `Error` with file and field if there is none, if
/// one was stopped early, or if one lacks what it should hold.
std::vector<MeasuredSweep> read_measured_sweeps(const std::filesystem::path& folder);

}  // namespace vestige
