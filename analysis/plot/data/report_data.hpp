#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"
#include "detector/method.hpp"

namespace vestige::plot {

/// The remedy for a damaged file of the folder.
inline constexpr std::string_view kFileRemedy =
    "run the same 'vestige batch' (or 'batch merge') again: it writes the file again";

/// A mean over traces and its 95 % interval. A value is absent if the batch has none (no trace has a value, or for the
/// interval fewer than two traces have one).
struct Estimate {
  std::optional<double> mean;
  std::optional<double> low;
  std::optional<double> high;
  std::size_t traces = 0;

  bool has_interval() const { return mean && low && high && traces > 1; }
};

struct ReportMetric {
  std::string name;
  std::string unit;    ///< empty: a plain number
  std::string better;  ///< "higher", "lower", "neither"
  bool model_based = false;
  std::string formula;
  std::string source;
};

/// A map with a law, and its results.
struct Candidate {
  std::optional<std::size_t> rank;  ///< from 1; none: no trace has a value
  std::string map;
  std::string law;
  Estimate headline;
  Estimate difference_from_best;
  std::optional<double> p;       ///< of the difference
  std::optional<double> p_holm;  ///< the same by Holm's correction
  bool distinguishable_from_best = false;
  std::vector<Estimate> metrics;                ///< in the order of `ReportData::metrics`; empty for one scenario alone
  std::vector<std::optional<double>> by_trace;  ///< headline, in the order of `ReportData::traces`; may be empty

  /// Ranked, and not to be told from the first.
  bool is_level() const { return rank && !distinguishable_from_best; }
};

/// The ranking by the traces of one scenario alone, or by the files alone.
struct ReportScenario {
  std::string name;
  std::size_t traces = 0;
  std::vector<Candidate> ranking;  ///< best first

  /// Returns a candidate of the whole batch, as this scenario ranks it. In a folder that was read, there is one.
  const Candidate* find(const Candidate& candidate) const;
};

struct ReportFailure {
  std::string what;  ///< "map" or "trace"
  std::string name;
  std::string given;
  std::string cause;
  std::string remedy;
};

struct ReportTrace {
  std::string name;
  std::string given;
  std::optional<double> seed;  ///< of a scenario; none for a file
  double frames = 0;
  double colliders = 0;
  double contacts = 0;
  std::vector<std::string> damage;
  std::string sha256;      ///< of its file; empty: unknown
  std::size_t person = 0;  ///< whom of the file's people, counted from 0
};

/// What 'vestige batch -o DIR' wrote, except contacts, maps and avatar.
struct ReportData {
  std::size_t headline = 0;                 ///< index into `metrics`
  std::string interval;                     ///< how intervals were made, in the batch's words; empty without any
  std::string why_no_intervals;             ///< in the batch's words; empty if there are any
  std::string reversals;                    ///< one sentence on scenarios where another is first; may be empty
  std::vector<ReportScenario> by_scenario;  ///< empty with one scenario
  std::vector<ReportMetric> metrics;
  std::vector<Candidate> ranking;  ///< best first
  std::vector<ReportTrace> traces;
  std::vector<ReportFailure> failures;
  std::map<std::string, std::vector<std::string>> map_warnings;  ///< by map, as the batch was given them
  std::string avatar_facing;                                     ///< as `take_recorded_facing` takes it
  std::string avatar_sha256;                                     ///< of avatar.glb; empty: unknown
  std::map<std::string, std::string> map_sha256;                 ///< of the judged maps: PNG, then sidecar
  std::vector<std::string> laws;                                 ///< in the order of the batch
  LawOptions law_options;                                        ///< options of all laws
  Method method = Method::kStatic;                               ///< by which contacts were found
  std::string detector;                                          ///< by which contacts were found; empty: unknown
  bool approximate = false;                                      ///< by a detector that simplifies the skin
  std::string actuator;                                          ///< file of the motors; empty: ideal motors
  std::string actuator_sha256;                                   ///< of actuator.json; empty: unknown
  std::shared_ptr<const ActuatorModel> actuators;                ///< the motors
  bool complete = true;                                          ///< false: the batch was stopped
  std::string shard;                                             ///< "1 of 3"; empty: the whole batch
  std::vector<std::pair<std::string, std::string>> provenance;   ///< name and value, as shown

  /// Returns the names of the ranked maps, best first.
  std::vector<std::string> maps() const;
  bool has_intervals() const { return !interval.empty(); }
  /// Returns the best candidate of a ranked map.
  const Candidate& best_of(const std::string& map) const;
  /// Returns what share of a trace's contacts a candidate lets feel, mean over traces (the metric `coverage`); none if
  /// no trace has contacts.
  std::optional<double> felt_share(const Candidate& candidate) const;
};

/// Throws `Error` if `file` is not what was judged. `judged` is the SHA-256 in run.json, or empty if unknown.
void require_judged(const std::string& file, const std::string& sha256, const std::string& judged);

/// Throws `Error` if a file of the folder, which the batch wrote, is missing.
void require_there(const std::filesystem::path& file);

/// Reads ranking.json, run.json and actuator.json. Throws `Error` with file and field. For a folder without a ranking,
/// the error says which command to run.
ReportData read_report(const std::filesystem::path& folder);

}  // namespace vestige::plot
