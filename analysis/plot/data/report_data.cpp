#include "analysis/plot/data/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "analysis/base/json_field.hpp"
#include "analysis/base/results_folder.hpp"
#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a folder that 'vestige batch' wrote, or run the batch again with --force";
constexpr std::string_view kGoOn = "run the same 'vestige batch' again: it continues where it stopped";
constexpr double kLeast = std::numeric_limits<double>::min();
constexpr double kMost = std::numeric_limits<double>::max();

std::optional<double> number(const JsonField& parent, const char* key) {
  if (!parent.has(key)) return std::nullopt;
  return parent.at(key).within(-kMost, kMost);
}

std::size_t whole(const JsonField& field) {
  return static_cast<std::size_t>(field.within(0, 1e15));
}

bool truth(const JsonField& field) {
  if (!field.value().is_boolean()) field.refuse("is neither true nor false");
  return field.value().get<bool>();
}

/// Lists may be empty here.
std::size_t length(const JsonField& field) {
  if (!field.value().is_array()) field.refuse("is not a list");
  return field.value().size();
}

/// Reads a name for files. The name must not lead to another folder.
std::string file_name(const JsonField& field) {
  std::string name = field.text();
  if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos)
    field.refuse(fmt::format("is '{}', which is not a name of a map, trace or law", name));
  return name;
}

Estimate read_estimate(const JsonField& field) {
  Estimate estimate;
  estimate.mean = number(field, "mean");
  estimate.low = number(field, "low");
  estimate.high = number(field, "high");
  estimate.traces = whole(field.at("n"));
  return estimate;
}

ReportMetric read_metric(const JsonField& field) {
  ReportMetric metric;
  metric.name = field.at("name").text();
  metric.unit = field.at("unit").text();
  metric.better = field.at("better").text();
  metric.model_based = truth(field.at("model_based"));
  metric.formula = field.at("formula").text();
  metric.source = field.at("source").text();
  return metric;
}

Candidate read_candidate(const JsonField& field, const std::vector<ReportMetric>& metrics) {
  Candidate candidate;
  if (field.has("rank")) candidate.rank = whole(field.at("rank"));
  candidate.map = file_name(field.at("map"));
  candidate.law = file_name(field.at("law"));
  candidate.headline = read_estimate(field.at("headline"));
  candidate.difference_from_best = read_estimate(field.at("difference_from_best"));
  candidate.p = number(field.at("difference_from_best"), "p");
  candidate.p_holm = number(field.at("difference_from_best"), "p_holm");
  candidate.distinguishable_from_best = truth(field.at("distinguishable_from_best"));
  if (metrics.empty()) return candidate;
  const JsonField values = field.at("metrics");
  for (const ReportMetric& metric : metrics) candidate.metrics.push_back(read_estimate(values.at(metric.name.c_str())));
  return candidate;
}

/// Reads what a batch of an earlier version lacks.
void read_by_scenario(const JsonField& document, ReportData& data) {
  if (document.has("why_no_intervals")) data.why_no_intervals = document.at("why_no_intervals").text();
  if (document.has("reversals")) data.reversals = document.at("reversals").text();
  if (!document.has("by_scenario")) return;
  const JsonField scenarios = document.at("by_scenario");
  for (std::size_t i = 0; i < length(scenarios); ++i) {
    ReportScenario& scenario = data.by_scenario.emplace_back();
    scenario.name = scenarios.at(i).at("scenario").text();
    scenario.traces = whole(scenarios.at(i).at("traces"));
    const JsonField ranking = scenarios.at(i).at("ranking");
    for (std::size_t k = 0; k < ranking.count(); ++k) scenario.ranking.push_back(read_candidate(ranking.at(k), {}));
    for (const Candidate& candidate : data.ranking)
      if (scenario.find(candidate) == nullptr)
        ranking.refuse(fmt::format("lacks {} with {}", candidate.map, candidate.law));
  }
}

void read_ranking(const std::filesystem::path& file, ReportData& data) {
  const nlohmann::json json = read_json(file, kRemedy);
  const JsonField document(json, file, kRemedy);
  const JsonField metrics = document.at("metrics");
  for (std::size_t i = 0; i < metrics.count(); ++i) data.metrics.push_back(read_metric(metrics.at(i)));
  const std::string rank_by = document.at("rank_by").text();
  const auto headline = std::ranges::find(data.metrics, rank_by, &ReportMetric::name);
  if (headline == data.metrics.end())
    document.at("rank_by").refuse(fmt::format("is '{}', which is not a metric", rank_by));
  data.headline = static_cast<std::size_t>(headline - data.metrics.begin());
  if (document.has("interval")) data.interval = document.at("interval").text();
  const JsonField ranking = document.at("ranking");
  for (std::size_t i = 0; i < ranking.count(); ++i) data.ranking.push_back(read_candidate(ranking.at(i), data.metrics));
  read_by_scenario(document, data);
}

/// Reads the headline of each trace. A folder need not have this file.
void read_scores(const std::filesystem::path& file, ReportData& data) {
  if (!std::filesystem::exists(file)) return;
  const nlohmann::json json = read_json(file, kFileRemedy);
  const JsonField scores = JsonField(json, file, kFileRemedy).at("scores");
  const std::string& headline = data.metrics[data.headline].name;
  std::map<std::string, std::size_t> trace_of;
  for (std::size_t i = 0; i < data.traces.size(); ++i) trace_of[data.traces[i].name] = i;
  std::map<std::pair<std::string, std::string>, Candidate*> candidate_of;
  for (Candidate& candidate : data.ranking) {
    candidate.by_trace.resize(data.traces.size());
    candidate_of[{candidate.map, candidate.law}] = &candidate;
  }
  for (std::size_t i = 0; i < length(scores); ++i) {
    const JsonField score = scores.at(i);
    const auto trace = trace_of.find(score.at("trace").text());
    if (trace == trace_of.end()) score.at("trace").refuse("is no trace of run.json");
    const auto candidate = candidate_of.find({score.at("map").text(), score.at("law").text()});
    if (candidate == candidate_of.end()) score.refuse("is of a map and law that ranking.json does not have");
    candidate->second->by_trace[trace->second] = number(score.at("values"), headline.c_str());
  }
}

/// Returns a word as a user could type it in a shell.
std::string quoted(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t\n'\"\\$&;|<>()*?[]{}~#!`") == std::string::npos) return word;
  std::string inside;
  for (const char letter : word) {
    if (letter == '\'')
      inside.append("'\\''");
    else
      inside.push_back(letter);
  }
  return fmt::format("'{}'", inside);
}

std::string words_of(const JsonField& list) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < length(list); ++i) words.push_back(quoted(list.at(i).text()));
  return fmt::format("{}", fmt::join(words, " "));
}

void read_provenance(const JsonField& run, ReportData& data) {
  const auto add = [&](const char* name, std::string value) {
    if (!value.empty()) data.provenance.emplace_back(name, std::move(value));
  };
  add("Command", words_of(run.at("argv")));
  if (run.has("time")) add("Finished", run.at("time").text());
  if (run.has("version")) add("Version", run.at("version").text());
  add("Commit", commit_of(run));
  if (run.has("machine"))
    add("Machine", phrase(run.at("machine"), {{"processor", ""}, {"cores", " cores"}, {"system", ""}}));
  const JsonField batch = run.at("batch");
  add("Avatar", phrase(batch.at("avatar"), {{"given", ""}, {"sha256", " (SHA-256)"}}));
  if (batch.has("options")) {
    const JsonField options = batch.at("options");
    add("Detection", phrase(options, {{"detector", options.has("approximate") ? " (approximate)" : ""},
                                      {"keep", " of the triangles"},
                                      {"method", ""},
                                      {"hold_ms", " ms hold"},
                                      {"seed", " as seed"}}));
  }
  if (run.has("totals")) {
    const JsonField totals = run.at("totals");
    const auto seconds = [&](const char* key) { return totals.has(key) ? totals.at(key).within(0, kMost) : 0; };
    add("Processor time", fmt::format("reading {:.2f} s, detection {:.2f} s, all maps and laws {:.2f} s",
                                      seconds("reading_s"), seconds("detection_s"), seconds("scoring_s")));
  }
}

/// A folder of an earlier version lacks these fields. Their values are then as they were in that version.
void read_law_options(const JsonField& options, ReportData& data) {
  if (options.has("hold_ms")) data.law_options.hold_s = options.at("hold_ms").within(0, kMost) / 1e3;
  for (const LawParameter& known : law_parameters())
    if (options.has(known.field))
      data.law_options.*known.option = options.at(known.field).within(kLeast, kMost) / known.per_unit;
  if (options.has("detector")) data.detector = options.at("detector").text();
  data.approximate = options.has("approximate");
  for (const Method method : {Method::kStatic, Method::kCarried, Method::kCcd})
    if (options.has("method") && options.at("method").text() == vestige::name_of(method)) data.method = method;
  if (!options.has("actuator")) return;
  const JsonField actuator = options.at("actuator");
  data.actuator = actuator.at("given").text();
  if (actuator.has("sha256")) data.actuator_sha256 = actuator.at("sha256").text();
}

std::shared_ptr<const ActuatorModel> read_actuators(const std::string& file, const ReportData& data) {
  require_there(file);
  const std::string text = read_text_file(file);
  require_judged(file, sha256_hex(std::as_bytes(std::span(text))), data.actuator_sha256);
  return std::make_shared<const ActuatorModel>(parse_actuator_model(text, file));
}

void read_run(const std::filesystem::path& file, ReportData& data) {
  const nlohmann::json json = read_json(file, kRemedy);
  const JsonField run(json, file, kRemedy);
  if (run.has("shard")) {
    const double count = run.at("shard").at("count").within(1, kMost);
    const double number = run.at("shard").at("number").within(1, count);
    if (count > 1) data.shard = fmt::format("{:.0f} of {:.0f}", number, count);
  }
  if (run.has("complete")) data.complete = truth(run.at("complete"));
  if (!data.complete && !run.has("traces"))
    throw Error(file.string(), "says that the batch is not finished and has no trace yet", kGoOn);
  read_provenance(run, data);
  const JsonField batch = run.at("batch");
  const JsonField laws = batch.at("laws");
  for (std::size_t i = 0; i < laws.count(); ++i) data.laws.push_back(file_name(laws.at(i)));
  if (batch.has("options")) read_law_options(batch.at("options"), data);
  if (batch.at("avatar").has("facing")) data.avatar_facing = batch.at("avatar").at("facing").text();
  if (batch.at("avatar").has("sha256")) data.avatar_sha256 = batch.at("avatar").at("sha256").text();
  if (batch.has("maps"))
    for (std::size_t i = 0; i < length(batch.at("maps")); ++i)
      if (const JsonField map = batch.at("maps").at(i); map.has("sha256"))
        data.map_sha256[map.at("name").text()] = map.at("sha256").text();
  if (run.has("maps")) {
    const JsonField maps = run.at("maps");
    for (std::size_t i = 0; i < length(maps); ++i) {
      const JsonField warnings = maps.at(i).at("warnings");
      std::vector<std::string>& of_map = data.map_warnings[maps.at(i).at("name").text()];
      for (std::size_t k = 0; k < length(warnings); ++k) of_map.push_back(warnings.at(k).text());
    }
  }
  std::map<std::string, double> seed_of;
  if (batch.has("traces"))
    for (std::size_t i = 0; i < length(batch.at("traces")); ++i)
      if (const JsonField trace = batch.at("traces").at(i); trace.has("seed"))
        seed_of[trace.at("name").text()] = trace.at("seed").within(0, kMost);
  const JsonField traces = run.at("traces");
  for (std::size_t i = 0; i < length(traces); ++i) {
    const JsonField field = traces.at(i);
    ReportTrace trace;
    trace.name = file_name(field.at("name"));
    trace.given = field.at("given").text();
    if (const auto seed = seed_of.find(trace.name); seed != seed_of.end()) trace.seed = seed->second;
    trace.frames = field.at("frames").within(0, kMost);
    trace.colliders = field.at("colliders").within(0, kMost);
    trace.contacts = field.at("contacts").within(0, kMost);
    if (field.has("sha256")) trace.sha256 = field.at("sha256").text();
    if (field.has("avatar")) trace.person = static_cast<std::size_t>(field.at("avatar").within(1, kMost)) - 1;
    if (field.has("damage"))
      for (std::size_t k = 0; k < length(field.at("damage")); ++k)
        trace.damage.push_back(field.at("damage").at(k).text());
    data.traces.push_back(std::move(trace));
  }
  const JsonField failures = run.at("failures");
  for (std::size_t i = 0; i < length(failures); ++i) {
    const JsonField field = failures.at(i);
    data.failures.push_back({field.at("what").text(), field.at("name").text(), field.at("given").text(),
                             field.at("cause").text(), field.at("remedy").text()});
  }
}

}  // namespace

const Candidate* ReportScenario::find(const Candidate& candidate) const {
  const auto found = std::ranges::find_if(
      ranking, [&](const Candidate& one) { return one.map == candidate.map && one.law == candidate.law; });
  return found == ranking.end() ? nullptr : &*found;
}

std::vector<std::string> ReportData::maps() const {
  std::vector<std::string> names;
  for (const Candidate& candidate : ranking)
    if (std::ranges::find(names, candidate.map) == names.end()) names.push_back(candidate.map);
  return names;
}

const Candidate& ReportData::best_of(const std::string& map) const {
  return *std::ranges::find(ranking, map, &Candidate::map);
}

std::optional<double> ReportData::felt_share(const Candidate& candidate) const {
  const auto coverage = std::ranges::find(metrics, "coverage", &ReportMetric::name);
  if (coverage == metrics.end()) return std::nullopt;
  return candidate.metrics[static_cast<std::size_t>(coverage - metrics.begin())].mean;
}

void require_judged(const std::string& file, const std::string& sha256, const std::string& judged) {
  if (judged.empty() || sha256 == judged) return;
  throw Error(file, "was changed after the batch scored it: the SHA-256 in run.json differs", kFileRemedy);
}

void require_there(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) return;
  // A folder without run.json is not known as a batch's.
  throw Error(file.string(), "is missing",
              fmt::format("run the same 'vestige batch' (or 'batch merge') again{}: it writes the file",
                          file.filename() == "run.json" ? " with --force" : ""));
}

ReportData read_report(const std::filesystem::path& folder) {
  require_folder(folder, "name the folder that 'vestige batch -o' wrote");
  if (std::filesystem::exists(folder / "accuracy.json"))
    throw Error(folder.string(), "is of 'vestige accuracy', which ranks no maps: accuracy.png and missed.html show it",
                "name the folder that 'vestige batch -o' wrote");
  if (!std::filesystem::exists(folder / "ranking.json"))
    throw Error(folder.string(), "has no ranking.json: no batch has finished here",
                std::filesystem::exists(folder / "run.json") ? fmt::format("{}; run.json says what failed", kGoOn)
                                                             : "run 'vestige batch -o' first, and name its folder");
  ReportData data;
  read_ranking(folder / "ranking.json", data);
  require_there(folder / "run.json");
  read_run(folder / "run.json", data);
  read_scores(folder / "scores.json", data);
  if (!data.actuator.empty()) data.actuators = read_actuators((folder / "actuator.json").string(), data);
  return data;
}

}  // namespace vestige::plot
