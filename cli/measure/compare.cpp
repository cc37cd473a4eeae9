#include "analysis/compare/compare.hpp"

#include <fmt/format.h>

#include <memory>

#include "analysis/base/provenance.hpp"
#include "analysis/compare/compare_report.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

struct CompareOptions {
  CommonOptions common;
  std::string a;
  std::string b;
  double threshold_percent = 6;
  bool across_machines = false;
};

void run_compare_verb(const CompareOptions& options, Invocation& invocation) {
  check_outputs({options.common.json}, {options.a, options.b}, options.common);
  const std::vector<MeasuredSweep> a = read_measured_sweeps(options.a);
  const std::vector<MeasuredSweep> b = read_measured_sweeps(options.b);
  if (std::filesystem::equivalent(options.a, options.b))
    throw Error(options.b, "is the folder that it is to be compared with", "name the folders of two runs");
  std::vector<std::string> inputs;
  for (const std::vector<MeasuredSweep>* run : {&a, &b})
    for (const MeasuredSweep& sweep : *run) {
      inputs.push_back(sweep.file.string());
      inputs.push_back(sweep.times_file.string());
    }
  check_outputs({options.common.json}, inputs, options.common);
  const double threshold = options.threshold_percent / 100;
  const SweepComparison comparison =
      compare_sweeps(a, b, threshold, options.across_machines ? Machines::kAny : Machines::kSame);

  const auto run_json = [](const std::string& folder, const MeasuredSweep& sweep) -> nlohmann::ordered_json {
    return {{"folder", folder}, {"commit", sweep.commit}, {"time", sweep.time}};
  };
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["a"] = run_json(options.a, a.front());
  json["b"] = run_json(options.b, b.front());
  json["threshold_percent"] = options.threshold_percent;
  json.update(to_json(comparison));
  write_json(options.common.json, json, options.common);

  for (const std::string& warning : comparison_warnings(comparison)) warn(warning, options.common.verbosity());
  const auto run_line = [](const char* name, const std::string& folder, const MeasuredSweep& sweep) {
    return fmt::format("{}: {}, commit {}, {}\n", name, folder, sweep.commit, sweep.time);
  };
  std::string text = run_line("A", options.a, a.front()) + run_line("B", options.b, b.front());
  text += comparison_table(comparison, threshold);
  if (options.common.verbose) {
    for (const std::string& name : comparison.only_a) text += fmt::format("only in A: {}\n", name);
    for (const std::string& name : comparison.only_b) text += fmt::format("only in B: {}\n", name);
  }
  print_summary(text, {options.common.json}, options.common);
  if (comparison.count(SpeedVerdict::kSlower) != 0) invocation.exit_code = kCheckFailed;
}

}  // namespace

void add_compare(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = add_verb(program, "compare", "Say what became slower or faster between two result folders",
                            "  vestige compare before after\n"
                            "  vestige compare before after --threshold 10 --json changes.json\n");
  verb->add_option("A", options->a, "Result folder of the earlier run: of 'vestige sweep -o', or one above several")
      ->required()
      ->type_name("DIR");
  verb->add_option("B", options->b, "Result folder of the later run, laid out alike")->required()->type_name("DIR");
  verb->add_option("--threshold", options->threshold_percent,
                   "Change of a frame's duration from which on it counts as slower or faster, in percent. A slower "
                   "point ends the verb with exit code 4")
      ->capture_default_str()
      ->check(help::between(0, 1000))
      ->type_name("PERCENT");
  verb->add_flag("--across-machines", options->across_machines,
                 "Compare runs of different machines or OpenGL renderers, too");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_compare_verb(*options, invocation); });
}

}  // namespace vestige::cli
