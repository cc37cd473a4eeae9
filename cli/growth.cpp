#include "analysis/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "analysis/growth_report.hpp"
#include "analysis/provenance.hpp"
#include "analysis/sweep_report.hpp"
#include "cli/contestants.hpp"
#include "cli/default_trace.hpp"
#include "cli/help/validators.hpp"
#include "cli/scene.hpp"
#include "cli/verbs.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

namespace {

/// Four times each: five subdivisions of the built-in avatar have 5 million triangles.
constexpr std::uint32_t kMostSubdivisions = 5;

struct GrowthOptions {
  CommonOptions common;
  ContestantChoice contestants = {{}, "paper,geometry,cpu,embree", "auto", "off,on"};
  std::string trace;
  std::string counts = "1,3,10,30,100,300,1000";
  GrowthSettings settings;
  bool no_figure = false;
  std::string output;
};

bool measured_nothing(const Growth& growth) {
  return std::ranges::all_of(growth.by_colliders, [](const SweepSeries& one) {
    return std::ranges::all_of(one.points, [](const SweepPoint& point) { return point.repetitions.empty(); });
  });
}

/// A subdivided avatar and another number of colliders change the contacts, but for all that promise the same alike.
std::vector<std::string> all_disagreements(const Growth& growth) {
  std::vector<std::string> found = disagreements(growth.by_colliders);
  for (const GrowthSize& size : growth.by_triangles)
    for (const std::string& sentence : disagreements(size.series))
      found.push_back(fmt::format("{} triangles: {}", size.triangles, sentence));
  return found;
}

void run_growth_verb(GrowthOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  SweepSettings& sweep = options.settings.sweep;
  sweep.counts = parse_counts(options.counts, "--counts");
  sweep.seed = options.common.seed;
  check_contestant_choice(options.contestants);
  const std::string json_path = options.output + "/growth.json";
  make_folder(options.output, "-o");
  const std::string new_trace = options.trace.empty() ? options.output + "/trace.mcap" : "";
  check_outputs({json_path, new_trace, options.common.json}, {options.trace}, options.common);

  catch_interrupts();
  if (!new_trace.empty())
    record_default_trace(new_trace, std::max(std::ranges::max(sweep.counts), options.settings.colliders),
                         options.common, invocation);
  const std::string path = new_trace.empty() ? options.trace : new_trace;
  OpenTrace trace(path, verbosity);
  Growth growth;
  {
    Progress progress("Measuring", verbosity);
    Verbosity once = verbosity;  // what the machine lacks is said for the first size only
    const auto make = [&](const Avatar& avatar) {
      return make_contestants(options.contestants, avatar, trace.map, std::exchange(once, Verbosity::kQuiet));
    };
    growth = run_growth(trace.reader, trace.avatar, make, options.settings,
                        [&](double share) { return progress.update(share); });
  }
  if (measured_nothing(growth))
    throw Error("growth", "was stopped before anything had been measured", "start it again, with --force");

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["avatar"] = to_json(trace.avatar);
  json["trace"] = path;
  json["complete"] = !interrupted();
  json["colliders"] = options.settings.colliders;
  json.update(to_json(growth, sweep.seed));
  write_json(json_path, json, options.common);
  write_json(options.common.json, json, options.common);

  if (interrupted()) warn("stopped early; what was measured so far was written", verbosity);
  for (const std::string& warning : noise_warnings(growth.by_colliders)) warn(warning, verbosity);
  const std::vector<std::string> wrong = all_disagreements(growth);
  for (const std::string& warning : wrong) warn(warning, verbosity);
  print_summary(growth_table(growth, options.settings.colliders), {options.common.json}, options.common);
  print_summary(fmt::format("written: {}\n", json_path), {options.common.json}, options.common);
  if (!options.no_figure && !interrupted()) draw_figure("growth", options.output, options.common);
  invocation.exit_code = report_damage(trace.reader, path, verbosity);
  if (interrupted()) invocation.exit_code = kDataLost;
  if (!wrong.empty()) invocation.exit_code = kCheckFailed;
}

}  // namespace

void add_growth(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<GrowthOptions>();
  options->settings.sweep.min_time_s = 0.5;
  CLI::App* verb =
      add_verb(program, "growth", "Measure how cost grows with colliders and with triangles, and what skipping saves",
               "  vestige growth -o growth\n"
               "  vestige growth man.mcap --counts 1,10 --count 10 --subdivisions 2 -o growth\n");
  verb->add_option("TRACE", options->trace, "The trace to measure on [default: the built-in avatar in a swarm]");
  verb->add_option("--counts", options->counts, "Numbers of colliders, as 1,10,40,100 or 1:100 or 5:100:5")
      ->capture_default_str()
      ->type_name("LIST");
  verb->add_option("--count", options->settings.colliders, "Colliders that every size of the avatar is measured with")
      ->capture_default_str()
      ->check(help::whole_number(1, 1000000));
  verb->add_option("--subdivisions", options->settings.subdivisions,
                   "How often the avatar's triangles are split into four; each size is measured")
      ->capture_default_str()
      ->check(help::whole_number(0, kMostSubdivisions));
  add_contestant_options(*verb, options->contestants);
  verb->add_option("--runs", options->settings.sweep.runs, "Places of the trace, evenly spread, that are measured")
      ->capture_default_str()
      ->check(help::whole_number(1, 10000));
  verb->add_option("--run-frames", options->settings.sweep.run_frames,
                   fmt::format("Consecutive frames at each place; above {} pairs of collider and triangle it is single "
                               "frames at 3 places",
                               kManyPairs))
      ->capture_default_str()
      ->check(help::whole_number(1, 100000));
  verb->add_option("--min-time", options->settings.sweep.min_time_s, "Seconds spent on every point, at least")
      ->capture_default_str()
      ->check(help::kPositive)
      ->type_name("S");
  verb->add_flag("--no-figure", options->no_figure, "Do not draw the figure");
  verb->add_option("-o,--output", options->output, "Folder for growth.json and the figure")
      ->required()
      ->type_name("DIR");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_growth_verb(*options, invocation); });
}

}  // namespace vestige::cli
