#include "cli/maps/batch_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "analysis/batch/batch_inputs.hpp"
#include "analysis/batch/rank_by.hpp"
#include "analysis/mapping/layouts.hpp"
#include "analysis/scoring/scores.hpp"
#include "cli/choices/scene_choice.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kScenarioGroup = "Scenarios among the traces";
constexpr const char* kErrorWithUnfelt = "error_with_unfelt_mm";

std::string describe_maps() {
  std::string text =
      "The actuator maps, separated by commas or blanks: the built-in one, a layout laid onto the avatar, or a PNG "
      "file";
  for (const std::string& name : layout_names())
    fmt::format_to(std::back_inserter(text), "\n  {:<8} {}", name, layout_summary(name));
  return text;
}

std::string scenario_names() {
  std::string text;
  for (const Scenario& scenario : scenarios()) text += fmt::format("{}{}", text.empty() ? "" : ", ", scenario.name);
  return text;
}

/// A misspelt name is no file of that name either: better said at once than after everything else.
void refuse_misspelt(const std::vector<std::string>& given, const char* flag, const char* what,
                     const std::vector<std::string_view>& names) {
  for (const std::string& word : given) {
    std::error_code ignored;
    if (std::ranges::find(names, word) != names.end() || std::filesystem::exists(word, ignored)) continue;
    const std::string meant = help::did_you_mean(word, names);
    const bool is_a_path = word.find_first_of("./") != std::string::npos;
    if (!meant.empty() || !is_a_path)
      throw UsageError(flag, fmt::format("{}: there is no such file", word),
                       fmt::format("{}the {} are: {}", meant, what, fmt::join(names, ", ")));
  }
}

/// As other lists, but a path that exists keeps the commas in its name.
std::vector<std::string> split_at_commas(const std::vector<std::string>& words, const char* flag) {
  std::vector<std::string> list;
  list.reserve(words.size());
  for (const std::string& word : words) {
    std::error_code ignored;
    const bool is_path = std::filesystem::exists(word, ignored);
    for (std::string& part : is_path ? std::vector{word} : parse_list(word)) {
      if (part.empty())
        throw UsageError(flag, fmt::format("'{}' has nothing on one side of a comma", word),
                         "name it, or leave the comma out");
      list.push_back(std::move(part));
    }
  }
  return list;
}

void check_distinct(const std::vector<std::string>& given, const std::string& flag) {
  std::set<std::string> seen;
  for (const std::string& one : given)
    if (!seen.insert(one).second) throw UsageError(flag, fmt::format("'{}' is given twice", one), "name each once");
}

std::vector<std::uint64_t> seeds_of(const BatchOptions& options) {
  if (options.seeds.empty()) return {options.common.seed};
  constexpr std::size_t kMostSeeds = 1000;  // of each scenario
  const std::vector<std::uint32_t> seeds = parse_counts(options.seeds, "--seeds");
  if (seeds.size() > kMostSeeds)
    throw UsageError(
        "--seeds",
        fmt::format("'{}' are {} seeds, and at most {} can be used", options.seeds, seeds.size(), kMostSeeds),
        "give fewer: 1:20 tells most maps apart");
  return {seeds.begin(), seeds.end()};
}

/// The laws that every trace can be judged under.
std::vector<std::string> laws_for_points() {
  std::vector<std::string> names = law_names();
  std::erase_if(names, [](const std::string& name) { return law_named(name).needs_radii; });
  return names;
}

void refuse_unused_parameters(const LawFlags& flags, const std::vector<std::string>& laws) {
  for (std::size_t i = 0; i < flags.parameters.size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    if (flags.parameters[i] &&
        std::ranges::none_of(laws, [&](const std::string& law) { return known.belongs_to(law); }))
      throw UsageError(known.flag, "no law in --laws uses this flag",
                       fmt::format("add {} to --laws, or leave the flag out", known.owners()));
  }
}

}  // namespace

CLI::Option* add_rank_by(CLI::App& verb, std::string& rank_by) {
  return verb.add_option("--rank-by", rank_by, "The metric that ranks maps and laws")->type_name("METRIC");
}

void add_batch_options(CLI::App& verb, BatchOptions& options) {
  const auto add_list = [&](const char* flag, std::vector<std::string>& list, const std::string& description) {
    const auto take = [flag, &list](const std::vector<std::string>& words) { list = split_at_commas(words, flag); };
    return verb.add_option_function<std::vector<std::string>>(flag, take, description)->required();
  };
  add_list("--maps", options.maps, describe_maps())->type_name("builtin|LAYOUT|FILE.png");
  add_list("--traces", options.traces,
           fmt::format("The traces: files, or scenarios to record on the avatar ({})", scenario_names()))
      ->type_name("FILE|SCENARIO");
  options.laws = fmt::format("{}", fmt::join(laws_for_points(), ","));
  verb.add_option_function<std::vector<std::string>>(
          "--laws",
          [&options](const std::vector<std::string>& words) {
            options.laws = fmt::format("{}", fmt::join(words, ","));
          },
          "The laws that turn a contact into intensities, separated by commas or blanks")
      ->default_str(options.laws)
      ->type_name("LIST");
  add_law_parameters(verb, options.law_parameters, "Options");
  add_rank_by(verb, options.rank_by)
      ->description(fmt::format("The metric that ranks maps and laws [default: {}, or with --unfelt-mm {}]",
                                default_metric_to_rank_by(), kErrorWithUnfelt));
  verb.add_option("--unfelt-mm", options.unfelt_mm,
                  fmt::format("Also gives each map and law an error in which a contact that is not felt counts as so "
                              "many millimetres: {} [default: what is not felt has no error]",
                              kErrorWithUnfelt))
      ->type_name("MM")
      ->check(help::kNotNegative);
  verb.add_option("-o,--output", options.output,
                  "Folder for the results; after a stop, the same command continues the batch")
      ->required()
      ->type_name("DIR");
  verb.add_option(
          "--avatar", options.avatar,
          "The avatar that maps and traces are for [default: the first trace's avatar; for a scenario, the built-in "
          "one]")
      ->type_name("builtin|FILE");
  const auto add_recording = [&](const char* name, auto& value, const std::string& description, const char* type) {
    return verb.add_option(name, value, description)->group(kScenarioGroup)->type_name(type);
  };
  add_recording("--rate", options.rate_hz, "Frames per second [default: 1000]", "HZ")
      ->check(help::between(help::kLeastRate_hz, help::kMostRate_hz));
  add_recording("--duration", options.duration_s, "How long the scene lasts, in seconds [default: 2]", "S")
      ->check(help::kPositive);
  add_recording("--seeds", options.seeds,
                "Records each scenario with each of these seeds, as 1:20 or 1,2,5. Intervals need several "
                "[default: --seed alone]",
                "LIST");
  add_morph_option(verb, options.morphs)->group(kScenarioGroup);
  add_recording("--count", options.count, describe_count(), "N")->check(help::whole_number(1, 1000000));
  add_detector_and_context(verb, options.choice);
  add_detector_options(verb, options.choice);
  add_common_options(verb, options.common);
}

std::string rank_by_of(const BatchOptions& options) {
  if (options.rank_by == kErrorWithUnfelt && !options.unfelt_mm)
    throw UsageError("--rank-by",
                     fmt::format("'{}' needs to know what counts as its error where nothing is felt", kErrorWithUnfelt),
                     "add --unfelt-mm, such as --unfelt-mm 150");
  if (!options.rank_by.empty()) return options.rank_by;
  return options.unfelt_mm ? kErrorWithUnfelt : default_metric_to_rank_by();
}

std::size_t headline_of(const std::string& rank_by) {
  const std::vector<std::string> names = names_to_rank_by();
  if (std::ranges::find(names, rank_by) == names.end())
    throw UsageError("--rank-by", fmt::format("there is no metric '{}' that can rank maps", rank_by),
                     fmt::format("{}choose one of: {}",
                                 help::did_you_mean(rank_by, std::vector<std::string_view>(names.begin(), names.end())),
                                 fmt::join(names, ", ")));
  return metric_to_rank_by(rank_by);
}

BatchPlan plan_of(const BatchOptions& options) {
  check_distinct(options.maps, "--maps");
  check_distinct(options.traces, "--traces");
  if (options.choice.surface != "all")
    throw UsageError("--surface", "all maps share one detection, so colliders cannot pass through unmapped skin",
                     "leave it out; 'vestige replay --surface mapped' takes one map");
  headline_of(rank_by_of(options));
  if (options.output == "-") throw UsageError("-o -", "a batch is a folder of files", "name a folder");
  std::vector<std::string_view> names;
  for (const Scenario& scenario : scenarios()) names.push_back(scenario.name);
  refuse_misspelt(options.traces, "--traces", "scenarios", names);
  const std::vector<std::string> layouts = layout_names();
  names.assign(layouts.begin(), layouts.end());
  names.emplace_back("builtin");
  refuse_misspelt(options.maps, "--maps", "layouts", names);
  BatchPlan plan;
  plan.traces = name_traces(options.traces, seeds_of(options));
  plan.laws = parse_names(options.laws, law_names(), "--laws");
  refuse_unused_parameters(options.law_parameters, plan.laws);
  plan.law_options = options.law_parameters.options();
  if (options.unfelt_mm) plan.unfelt_m = *options.unfelt_mm / 1e3;
  plan.detector = options.choice.detector == "auto" ? "cpu" : options.choice.detector;
  plan.approximate = is_approximate(plan.detector);
  plan.takes_radii = takes_radii(plan.detector);
  plan.keep = options.choice.keep;
  plan.method = options.choice.method;
  plan.skip = options.choice.skip;
  plan.seed = options.common.seed;
  if ((options.rate_hz || options.duration_s || options.count || !options.seeds.empty()) && !plan.has_scenario())
    throw UsageError(options.rate_hz      ? "--rate"
                     : options.duration_s ? "--duration"
                     : options.count      ? "--count"
                                          : "--seeds",
                     "applies to scenarios only, and none of the traces is a scenario", "leave it out");
  plan.recording.rate_hz = options.rate_hz.value_or(plan.recording.rate_hz);
  plan.recording.duration_s = options.duration_s.value_or(plan.recording.duration_s);
  plan.recording.count = options.count;
  if (plan.has_scenario())
    refuse_too_many_frames(plan.recording.rate_hz * plan.recording.duration_s, "--duration",
                           "use a shorter --duration, or a lower --rate");
  return plan;
}

void warn_of_inputs(const nlohmann::ordered_json& run, Verbosity verbosity) {
  const auto list = [](const nlohmann::ordered_json& json, const char* field) {
    return json.value(field, nlohmann::ordered_json::array());
  };
  for (const nlohmann::ordered_json& warning : list(run.value("avatar", nlohmann::ordered_json::object()), "warnings"))
    warn(warning.get<std::string>(), verbosity);
  for (const nlohmann::ordered_json& map : list(run, "maps"))
    for (const nlohmann::ordered_json& warning : list(map, "warnings"))
      warn(fmt::format("map '{}': {}", map.value("name", ""), warning.get<std::string>()), verbosity);
}

std::vector<std::string> arguments_of(const BatchOptions& options) {
  std::vector<std::string> words = {"--maps"};
  words.insert(words.end(), options.maps.begin(), options.maps.end());
  words.emplace_back("--traces");
  words.insert(words.end(), options.traces.begin(), options.traces.end());
  const auto add = [&](const char* flag, const std::string& value) { words.insert(words.end(), {flag, value}); };
  add("--laws", options.laws);
  const LawFlags& law = options.law_parameters;
  for (std::size_t i = 0; i < law.parameters.size(); ++i)
    if (law.parameters[i]) add(law_parameters()[i].flag, fmt::format("{}", *law.parameters[i]));
  if (!law.actuator.empty()) add("--actuator", law.actuator);
  add("--hold", fmt::format("{}", law.hold_ms));
  add("--rank-by", rank_by_of(options));
  if (options.unfelt_mm) add("--unfelt-mm", fmt::format("{}", *options.unfelt_mm));
  if (!options.avatar.empty()) add("--avatar", options.avatar);
  if (options.morphs.ignored) words.emplace_back("--ignore-morphs");
  if (options.rate_hz) add("--rate", fmt::format("{}", *options.rate_hz));
  if (options.duration_s) add("--duration", fmt::format("{}", *options.duration_s));
  if (options.count) add("--count", fmt::format("{}", *options.count));
  if (!options.seeds.empty()) add("--seeds", options.seeds);
  add("--detector", options.choice.detector);
  if (options.choice.context != "auto") add("--context", options.choice.context);
  if (options.choice.device >= 0) add("--device", fmt::format("{}", options.choice.device));
  if (options.choice.detector == "decimated") add("--keep", fmt::format("{}", options.choice.keep));
  add("--method", options.choice.method);
  add("--skip", options.choice.skip);
  add("--seed", fmt::format("{}", options.common.seed));
  if (options.common.force) words.emplace_back("--force");
  return words;
}

}  // namespace vestige::cli
