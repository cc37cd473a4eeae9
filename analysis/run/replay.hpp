#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/run/comparison.hpp"
#include "analysis/run/detector_team.hpp"
#include "analysis/run/person_replay.hpp"
#include "detector/detector.hpp"
#include "detector/output/contacts_file.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "detector/output/texture_exr.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// What a replay is compared with. At most one of the two is set.
struct ReplayExpectation {
  DetectorTeam* detectors = nullptr;                       ///< run on the same frames for comparison
  const std::vector<RecordedContact>* contacts = nullptr;  ///< contacts of an earlier run, frames ascend
};

/// What to do with every frame of a trace. A null output is left out.
struct ReplayPlan {
  std::vector<ReplayPerson> people;  ///< all of the trace, in its order
  ContactsFile* contacts = nullptr;
  TextureExr* textures = nullptr;
  ReplayExpectation expectation = {};
};

struct ReplayResult {
  std::uint64_t frames = 0;
  std::vector<PersonResult> people;  ///< in the order of the trace
  DetectorWork work;
  // Sums over all people. A segment counts once for each person against whom it is tested.
  std::uint64_t contacts = 0;
  std::uint64_t origin_changes = 0;
  std::uint64_t non_finite_frames = 0;
  std::uint64_t non_finite_segments = 0;
  std::optional<std::uint64_t> first_non_finite;  ///< index of the first frame with a non-finite pose or segment
  std::string texture_hash;                       ///< `texture_hash_of` the people's
  std::string contacts_hash;                      ///< `texture_hash_of` the people's hashes of contacts
  double reading_s = 0;                           ///< decoding the trace
  /// Whole round trips. If there are several threads, all that they do meanwhile: they read and write beside it.
  double detection_s = 0;
  std::optional<Comparison> comparison;
  bool interrupted = false;
};

/// Runs all frames of `trace` through `detectors`, which have one detector for each person. Their rows must carry what
/// the outputs need and `kHashedPlanes`; if `plan` has map changes, texture coordinates too. `progress` is told the
/// share done and returns false to stop early.
ReplayResult replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan,
                    const std::function<bool(double)>& progress);

}  // namespace vestige
