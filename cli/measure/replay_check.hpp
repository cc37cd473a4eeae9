#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/run/replay.hpp"
#include "cli/choices/scene.hpp"
#include "cli/measure/replay_options.hpp"

namespace vestige::cli {

/// What --verify names: another detector, or a file that an earlier replay wrote. Without --verify, nothing.
struct Verification {
  std::unique_ptr<DetectorTeam> detectors;
  std::vector<RecordedContact> contacts;
  std::string texture_hash;
  bool by_contacts = false;

  ReplayExpectation expectation() const { return {detectors.get(), by_contacts ? &contacts : nullptr}; }
};

/// Returns the contacts that --verify names, if it names such a file, for a trace of this many people.
std::optional<std::vector<RecordedContact>> read_expected(const std::string& verify, std::size_t people);

/// Makes ready what the replay by `detector` is compared with: detectors that give `planes`, or a file. `expected` is
/// from `read_expected`, so that contacts are read before any thread starts. Throws `UsageError` or `Error` for what is
/// neither.
Verification load_verification(const ReplayOptions& options, const OpenTrace& trace, const Detector& detector,
                               PlaneSet planes, std::optional<std::vector<RecordedContact>> expected);

/// Prints how the comparison went; returns the exit code. `outputs` are the files that the replay writes.
int report_verification(const ReplayOptions& options, const ReplayResult& result, const Verification& verification,
                        const std::vector<std::string>& outputs);

}  // namespace vestige::cli
