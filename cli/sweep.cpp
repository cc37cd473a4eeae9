#include "analysis/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "analysis/provenance.hpp"
#include "analysis/sweep_report.hpp"
#include "cli/contestants.hpp"
#include "cli/default_trace.hpp"
#include "cli/help/validators.hpp"
#include "cli/scene.hpp"
#include "cli/verbs.hpp"
#include "traces/error.hpp"
#include "traces/mcap/compression.hpp"

namespace vestige::cli {

namespace {

struct SweepOptions {
  CommonOptions common;
  ContestantChoice contestants = {{}, "paper,cpu", "egl,osmesa", "on"};
  std::string trace;
  std::string counts = "1:100";
  SweepSettings settings;
  bool no_figure = false;
  std::string output;
};

/// The series' own GL first; the whole file's is that of the first series that has one.
nlohmann::ordered_json first_gl(std::span<const SweepSeries> series) {
  for (const SweepSeries& one : series)
    if (!one.gl.context.empty()) return to_json(one.gl);
  return nullptr;
}

void run_sweep_verb(SweepOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  options.settings.counts = parse_counts(options.counts, "--counts");
  options.settings.seed = options.common.seed;
  check_contestant_choice(options.contestants);
  const std::string json_path = options.output + "/sweep.json";
  const std::string times_path = options.output + "/frame_times.csv.zst";
  make_folder(options.output, "-o");
  const std::string new_trace = options.trace.empty() ? options.output + "/trace.mcap" : "";
  check_outputs({json_path, times_path, new_trace, options.common.json}, {options.trace}, options.common);

  catch_interrupts();
  if (!new_trace.empty())
    record_default_trace(new_trace, std::ranges::max(options.settings.counts), options.common, invocation);
  const std::string path = new_trace.empty() ? options.trace : new_trace;
  OpenTrace trace(path, verbosity);
  const std::vector<Contestant> contestants = make_contestants(options.contestants, trace.avatar, trace.map, verbosity);
  std::vector<SweepSeries> series;
  {
    Progress progress("Measuring", verbosity);
    series = run_sweep(trace.reader, trace.avatar, contestants, options.settings,
                       [&](double share) { return progress.update(share); });
  }

  if (std::ranges::all_of(series, [](const SweepSeries& one) {
        return std::ranges::all_of(one.points, [](const SweepPoint& point) { return point.repetitions.empty(); });
      }))
    throw Error("sweep", "was stopped before anything had been measured", "start it again, with --force");

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["gl"] = first_gl(series);
  json["avatar"] = to_json(trace.avatar);
  json["trace"] = path;
  json["complete"] = !interrupted();
  json["series"] = to_json(series, options.settings.seed);
  write_json(json_path, json, options.common);
  write_json(options.common.json, json, options.common);
  std::vector<std::byte> compressed;
  const std::string times = frame_times_csv(series);
  mcap::compress(Compression::kZstd, std::as_bytes(std::span(times)), compressed);
  OutputFile times_file(times_path, options.common.overwrite());
  times_file.write(compressed);
  times_file.commit();

  if (interrupted()) warn("stopped early; what was measured so far was written", verbosity);
  for (const std::string& warning : noise_warnings(series)) warn(warning, verbosity);
  const std::vector<std::string> wrong = disagreements(series);
  for (const std::string& warning : wrong) warn(warning, verbosity);
  print_summary(sweep_table(series, options.settings.seed), {options.common.json}, options.common);
  print_summary(fmt::format("written: {}, {}\n", json_path, times_path), {options.common.json}, options.common);
  if (!options.no_figure && !interrupted()) draw_figure("sweep", options.output, options.common);
  invocation.exit_code = report_damage(trace.reader, path, verbosity);
  if (interrupted()) invocation.exit_code = kDataLost;
  if (!wrong.empty()) invocation.exit_code = kCheckFailed;
}

}  // namespace

void add_sweep(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* verb = add_verb(program, "sweep", "Measure detection frequency against the number of colliders",
                            "  vestige sweep -o sweep\n"
                            "  vestige sweep man.mcap --counts 1,10,40,100 --detector paper,cpu -o sweep\n");
  verb->add_option("TRACE", options->trace, "The trace to measure on [default: the built-in avatar in a swarm]");
  verb->add_option("--counts", options->counts, "Numbers of colliders, as 1,10,40,100 or 1:100 or 5:100:5")
      ->capture_default_str()
      ->type_name("LIST");
  add_contestant_options(*verb, options->contestants);
  verb->add_option("--renderer", options->contestants.renderer,
                   "on: measures everything also while a second thread draws the scene at 90 Hz in a context of its "
                   "own, as HAVE 2010 does")
      ->capture_default_str()
      ->check(CLI::IsMember({"on", "off"}));
  verb->add_option("--runs", options->settings.runs, "Places of the trace, evenly spread, that are measured")
      ->capture_default_str()
      ->check(help::whole_number(1, 10000));
  verb->add_option("--run-frames", options->settings.run_frames, "Consecutive frames at each place")
      ->capture_default_str()
      ->check(help::whole_number(1, 100000));
  verb->add_option("--min-time", options->settings.min_time_s, "Seconds spent on every point, at least")
      ->capture_default_str()
      ->check(help::kPositive)
      ->type_name("S");
  verb->add_flag("--no-figure", options->no_figure, "Do not draw the figure");
  verb->add_option("-o,--output", options->output, "Folder for sweep.json, every frame's duration, and the figure")
      ->required()
      ->type_name("DIR");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_sweep_verb(*options, invocation); });
}

}  // namespace vestige::cli
