#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/explain/fields.hpp"
#include "analysis/scoring/metrics.hpp"

namespace vestige {

namespace {

constexpr Field kScore[] = {
    {"map", "", "the actuator map"},
    {"trace", "", "the trace, or the scenario and its seed"},
    {"law", "", "the intensity law"},
    {"scenario", "", "the scenario; empty or null: a recorded file"},
    {"seed", "", "its seed; empty or null: a recorded file"},
    {"contacts", "", "contacts of the trace"},
};

// What the columns and fields of all rankings have.
constexpr Field kRanked[] = {
    {"rank", "", "place in the order, equal for equal values; empty or null: no trace has a value"},
    {"map", "", "the actuator map"},
    {"law", "", "the intensity law"},
};

constexpr Field kRankedRow[] = {
    {"traces", "", "traces in which the metric that ranks has a value"},
    {"difference_from_best", "", "mean difference from the leader over traces; empty: not compared"},
    {"difference_low", "", "low end of its 95 % interval, which does not reach beyond 0"},
    {"difference_high", "", "high end of that interval"},
    {"p", "", "chance of a difference at least as large if there were none; the leader: 1; empty: not compared"},
    {"p_holm", "", "p by Holm's correction for many comparisons"},
    {"distinguishable_from_best", "", "yes: p_holm is below 0.05; no: it is not; empty: not compared"},
};

constexpr Field kWhyNoInterval[] = {
    {"why_no_interval", "", "why the row has no interval; empty: it has one"},
};

constexpr Field kScenario[] = {
    {"scenario", "", "the scenario of this ranking"},
};

constexpr Field kMetric[] = {
    {"name", "", "name of a metric, which is its column"},
    {"unit", "", "its unit; empty: none"},
    {"better", "", "higher, lower or neither: what is better"},
    {"model_based", "", "true: from a model, not from a user study"},
    {"formula", "", "how it is computed"},
    {"source", "", "where it comes from"},
};

constexpr Field kRanking[] = {
    {"rank_by", "", "the metric that ranks"},
    {"better", "", "higher or lower: what is better"},
    {"model_based", "", "true: from a model, not from a user study"},
    {"traces", "", "traces that were scored"},
    {"seed", "", "seed of the resamples"},
    {"interval", "", "how intervals were computed; null: there are none"},
    {"why_no_intervals", "", "why there are none; null: there are"},
    {"over", "", "what the ranking is over, in words: 6 scenarios x 20 seeds"},
    {"reversals", "", "scenarios on which another is first, in words; empty: none"},
    {"by_scenario/scenario", "", "a scenario"},
    {"by_scenario/traces", "", "its traces"},
};

constexpr Field kRankedObject[] = {
    {"traces", "", "traces in which the metric that ranks has a value"},
    {"headline/mean", "", "mean of the metric that ranks"},
    {"headline/low", "", "low end of its 95 % interval; null: none"},
    {"headline/high", "", "high end of that interval"},
    {"headline/n", "", "traces that have a value"},
    {"difference_from_best/mean", "", "mean difference from the leader; null: not compared"},
    {"difference_from_best/low", "", "low end of its 95 % interval"},
    {"difference_from_best/high", "", "high end of that interval"},
    {"difference_from_best/n", "", "traces that have a value"},
    {"difference_from_best/p", "",
     "chance of a difference at least as large if there were none; the leader: 1; null: not compared"},
    {"difference_from_best/p_holm", "", "p by Holm's correction for many comparisons"},
    {"distinguishable_from_best", "", "true: p_holm is below 0.05; false: it is not, or not compared"},
    {"metrics/*/mean", "", "mean of that metric over traces; null: none has a value"},
    {"metrics/*/low", "", "low end of its 95 % interval; null: none"},
    {"metrics/*/high", "", "high end of that interval"},
    {"metrics/*/n", "", "traces that have a value"},
};

// What the batch is, whoever runs it.
constexpr Field kBatch[] = {
    {"batch/program", "", "version and commit of the program"},
    {"batch/avatar/given", "", "the avatar, as given"},
    {"batch/avatar/sha256", "", "SHA-256 of its file"},
    {"batch/avatar/facing", "", "axis along which it looks at rest"},
    {"batch/maps/name", "", "name of a map in results"},
    {"batch/maps/given", "", "the map, as given"},
    {"batch/maps/sha256", "", "SHA-256 of its files; null: it could not be used"},
    {"batch/laws", "", "intensity laws"},
    {"batch/options/hold_ms", "ms", "how long an actuator runs on after a contact"},
    {"batch/options/full_speed_m_per_s", "m/s", "speed that drives an actuator fully; null: the default"},
    {"batch/options/full_depth_mm", "mm", "depth that drives an actuator fully; null: the default"},
    {"batch/options/sigma_mm", "mm", "width of a contact; null: the default, by map"},
    {"batch/options/unfelt_mm", "mm", "a contact that is not felt counts as so many; null: it does not count"},
    {"batch/options/actuator", "", "null: ideal actuators"},
    {"batch/options/actuator/given", "", "the file of the actuator's model"},
    {"batch/options/actuator/sha256", "", "its SHA-256"},
    {"batch/options/detector", "", "the detector"},
    {"batch/options/approximate", "", "true: simpler shapes stood for the skin"},
    {"batch/options/keep", "", "share of the triangles that decimated keeps"},
    {"batch/options/method", "", "static, carried or ccd"},
    {"batch/options/skip", "", "on: what cannot touch was skipped"},
    {"batch/options/seed", "", "seed of resamples, and of scenarios without --seeds"},
    {"batch/options/scenarios", "", "null: only recorded files"},
    {"batch/options/scenarios/rate_hz", "Hz", "rate at which scenarios are recorded"},
    {"batch/options/scenarios/duration_s", "s", "their length"},
    {"batch/options/scenarios/count", "", "number of colliders; null: the scenario's own"},
    {"batch/traces/name", "", "name of a trace in results"},
    {"batch/traces/given", "", "the trace or scenario, as given"},
    {"batch/traces/seed", "", "the scenario's seed"},
    {"batch/traces/avatar", "", "whose contacts these are, of a trace of several people, from 1 on"},
};

constexpr Field kBatchRun[] = {
    {"shard/number", "", "which part of the batch this run computed, from 1 on"},
    {"shard/count", "", "into how many parts it is split"},
    {"rank_by", "", "the metric that ranks"},
    {"complete", "", "false: interrupted, or still running"},
    {"jobs", "", "number of threads"},
    {"wall_s", "s", "how long the run took"},
    {"avatar/warnings", "", "what was odd about the avatar"},
    {"maps/name", "", "name of a map"},
    {"maps/warnings", "", "what was odd about it"},
    {"traces/name", "", "name of a trace"},
    {"traces/given", "", "the trace or scenario, as given"},
    {"traces/avatar", "", "whose contacts these are, of a trace of several people, from 1 on"},
    {"traces/sha256", "", "SHA-256 of its file"},
    {"traces/frames", "", "its frames"},
    {"traces/colliders", "", "its colliders"},
    {"traces/contacts", "", "its contacts"},
    {"traces/damage", "", "its parts that could not be read, a sentence each"},
    {"traces/earlier", "", "true: an earlier run had scored it"},
    {"traces/time", "", "when it was scored, UTC; null: not known"},
    {"failures/what", "", "map or trace"},
    {"failures/name", "", "its name"},
    {"failures/given", "", "as given"},
    {"failures/cause", "", "why it was left out"},
    {"failures/remedy", "", "what to do"},
    {"totals/traces", "", "traces that were scored"},
    {"totals/scores", "", "traces x maps x laws"},
    {"merged/shard/number", "", "a part that was merged"},
    {"merged/shard/count", "", "of so many"},
    {"merged/argv", "", "its command line"},
    {"merged/time", "", "when it was written, UTC"},
    {"merged/machine/*", "", "its machine, as in machine"},
    {"merged/jobs", "", "its threads"},
    {"merged/wall_s", "s", "how long it took"},
};

constexpr Field kCosts[] = {
    {"recording_s", "s", "processor time of recording the scenario; null: not known"},
    {"reading_s", "s", "processor time of reading the trace; null: not known"},
    {"detection_s", "s", "processor time of detecting; null: not known"},
    {"scoring_s", "s", "processor time of all maps and laws; null: not known"},
};

constexpr Field kTotals[] = {
    {"recording_s", "s", "processor time of recording scenarios, as far as known"},
    {"reading_s", "s", "processor time of reading traces, as far as known"},
    {"detection_s", "s", "processor time of detecting, as far as known"},
    {"scoring_s", "s", "processor time of all maps and laws, as far as known"},
};

constexpr Field kItem[] = {
    {"key", "", "SHA-256 of all that the scores depend on but the trace; equal: the item can be used again"},
    {"trace", "", "name of the trace"},
    {"trace_sha256", "", "SHA-256 of its file"},
    {"contacts_sha256", "", "SHA-256 of its contacts' file"},
    {"frames", "", "its frames"},
    {"colliders", "", "its colliders"},
    {"contacts", "", "its contacts"},
    {"origin_changes", "", "how often the origin of computing followed the body, which had gone more than 2 m"},
    {"non_finite_frames", "", "frames whose pose has NaN or infinity; they fire nothing"},
    {"non_finite_segments", "", "segments with such an end; they fire nothing"},
    {"damage", "", "its parts that could not be read, a sentence each"},
    {"scores/map", "", "the actuator map"},
    {"scores/law", "", "the intensity law"},
};

constexpr Field kContactRecording[] = {
    {"frame", "", "frame, counted from 0 on; a frame without contact has a row whose other fields are empty"},
    {"time_s", "s", "time of the frame, from the trace's start"},
    {"collider", "", "id of the collider"},
    {"triangle", "", "triangle of the avatar, from 0 on"},
    {"t", "", "when within the frame's step, 0 to 1"},
    {"u", "", "weight of the triangle's second vertex"},
    {"v", "", "weight of the triangle's third vertex"},
    {"texture_u", "", "texture coordinate, not wrapped"},
    {"texture_v", "", "texture coordinate, not wrapped"},
    {"side", "", "+1 entering, -1 leaving, 0 in the triangle's plane"},
    {"speed_m_per_s", "m/s", "speed of the collider along the triangle's normal, 0 or more"},
    {"depth_m", "m", "how deep the sphere is in the body at the frame's end; only if colliders have a radius"},
    {"covered", "",
     "MAP:ACTUATOR:DEPTH for each actuator of each map whose place on the skin the sphere covers, depth in metres; "
     "only "
     "with the law patch"},
};

/// The metrics' names and meanings as texts that last, for `Field` only refers to texts.
class MetricTable {
 public:
  enum class Ends : bool { kNo, kYes };
  explicit MetricTable(Ends ends) {
    texts_.reserve(3 * metrics().size());
    for (const Metric& metric : metrics()) {
      texts_.push_back(fmt::format("{}{}", metric.formula, metric.model_based ? "; from a model" : ""));
      fields_.push_back({metric.name, metric.unit, texts_.back()});
      if (ends == Ends::kNo) continue;
      for (const auto& [end, meaning] : {std::pair("_low", kLow), std::pair("_high", kHigh)}) {
        texts_.push_back(fmt::format("{}{}", metric.name, end));
        fields_.push_back({texts_.back(), metric.unit, meaning});
      }
    }
  }
  std::span<const Field> fields() const { return fields_; }

 private:
  static constexpr std::string_view kLow = "low end of the 95 % interval of the mean; empty: none";
  static constexpr std::string_view kHigh = "high end of that interval";
  std::vector<std::string> texts_;  // reserved, so that texts stay where they are
  std::vector<Field> fields_;
};

std::span<const Field> metric_values() {
  static const MetricTable table(MetricTable::Ends::kNo);
  return table.fields();
}

std::span<const Field> metric_intervals() {
  static const MetricTable table(MetricTable::Ends::kYes);
  return table.fields();
}

FieldGroups ranking_below(std::string_view ranking, std::string_view row, std::string_view scenario,
                          std::string_view metric) {
  return {{ranking, kRanking},       {row, kRanked},   {row, kRankedObject}, {scenario, kRanked},
          {scenario, kRankedObject}, {metric, kMetric}};
}

}  // namespace

FieldGroups score_table_fields() {
  return {{"", kScore}, {"", metric_values()}};
}

FieldGroups score_fields() {
  return {{"metrics", kMetric}, {"scores", kScore}, {"scores/values", metric_values()}, {"", version_field()}};
}

FieldGroups ranking_table_fields() {
  return {{"", kRanked}, {"", kRankedRow}, {"", kWhyNoInterval}, {"", metric_intervals()}};
}

FieldGroups scenario_ranking_table_fields() {
  return {{"", kScenario}, {"", kRanked}, {"", kRankedRow}, {"", metric_intervals()}};
}

FieldGroups ranking_fields() {
  FieldGroups groups = ranking_below("", "ranking", "by_scenario/ranking", "metrics");
  groups.push_back({"", version_field()});
  return groups;
}

FieldGroups batch_run_fields() {
  FieldGroups groups = {{"", kBatch}, {"", kBatchRun}, {"traces", kCosts}, {"totals", kTotals}, {"", origin_fields()}};
  const FieldGroups ranking =
      ranking_below("ranking", "ranking/ranking", "ranking/by_scenario/ranking", "ranking/metrics");
  groups.insert(groups.end(), ranking.begin(), ranking.end());
  groups.push_back({"ranking", version_field()});
  return groups;
}

FieldGroups batch_item_fields() {
  return {{"", kItem}, {"scores/values", metric_values()}, {"", version_field()}};
}

FieldGroups batch_times_fields() {
  return {{"", kCosts}, {"", origin_fields()}};
}

FieldGroups batch_contact_fields() {
  return {{"", kContactRecording}};
}

}  // namespace vestige
