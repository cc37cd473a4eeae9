#include "analysis/frequency/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "analysis/base/provenance.hpp"
#include "analysis/frequency/sweep_report.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/sweep_choice.hpp"
#include "cli/verbs.hpp"
#include "traces/base/number_text.hpp"
#include "traces/mcap/compression.hpp"

namespace vestige::cli {

namespace {

struct SweepOptions {
  SweepChoice choice = {{{}, "paper,cpu", "egl,osmesa", "on"}, "1:100"};
  SweepSettings settings;
};

/// The series' own GL first; the whole file's is that of the first series that has one.
nlohmann::ordered_json first_gl(std::span<const SweepSeries> series) {
  for (const SweepSeries& one : series)
    if (!one.gl.context.empty()) return to_json(one.gl);
  return nullptr;
}

void run_sweep_verb(SweepOptions& options, Invocation& invocation) {
  const SweepChoice& choice = options.choice;
  const CommonOptions& common = choice.common;
  const Verbosity verbosity = common.verbosity();
  check_sweep_choice(choice, options.settings);
  const std::string json_path = choice.output + "/sweep.json";
  const std::string times_path = choice.output + "/frame_times.csv.zst";
  const std::string path =
      prepare_sweep(choice, {json_path, times_path}, std::ranges::max(options.settings.counts), invocation);
  OpenTrace trace(path, verbosity);
  leave_out_missing_colliders(choice, trace.reader.collider_ids().size(), options.settings);
  const std::vector<Contestant> contestants =
      make_contestants(choice.contestants, trace.person().avatar, trace.person().map, verbosity);
  std::set<std::string> names;
  for (const Contestant& contestant : contestants) names.insert(contestant.detector);
  warn_of_radii({names.begin(), names.end()}, trace.reader, path, verbosity);
  const std::unique_ptr<Detector> survey = make_survey(choice.contestants, trace.person().avatar, trace.person().map);
  Sweep sweep;
  {
    Progress progress("Measuring", verbosity);
    sweep = run_sweep(trace.reader, trace.person().avatar, *survey, contestants, options.settings,
                      [&](double share) { return progress.update(share); });
  }
  const std::vector<SweepSeries>& series = sweep.series;
  check_measured("sweep", series);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["gl"] = first_gl(series);
  json["avatar"] = to_json(trace.person().avatar);
  json["trace"] = path;
  json["surface"] = choice.contestants.choice.surface;
  json["runs"] = sweep.places;
  json["run_frames"] = sweep.place_frames;
  json["min_time_s"] = options.settings.min_time_s;
  json["seed"] = options.settings.seed;
  json["sample"] = sample_json(sweep);
  json["complete"] = !interrupted();
  json["series"] = to_json(series, options.settings.seed);
  write_json(json_path, json, common);
  write_json(common.json, json, common);
  std::vector<std::byte> compressed;
  const std::string times = frame_times_csv(series);
  mcap::compress(Compression::kZstd, std::as_bytes(std::span(times)), compressed);
  OutputFile times_file(times_path, common.overwrite());
  times_file.write(compressed);
  times_file.commit();

  if (interrupted()) warn("stopped early; the results so far were written, and no figure is drawn", verbosity);
  if (sweep.places < options.settings.runs || sweep.place_frames < options.settings.run_frames)
    warn(fmt::format("the trace has room for {} of {}, fewer than --runs and --run-frames ask for",
                     counted(sweep.places, "run"), counted(sweep.place_frames, "frame")),
         verbosity);
  for (const std::string& warning : noise_warnings(series)) warn(warning, verbosity);
  const std::vector<std::string> wrong = disagreements(series);
  for (const std::string& warning : wrong) warn(warning, verbosity);
  print_summary(sweep_table(series, options.settings.seed) + sample_sentence(sweep), {common.json}, common);
  print_summary(fmt::format("written: {}, {}\n", json_path, times_path), {common.json}, common);
  const bool wants_figures = !choice.no_figure && !interrupted();
  draw_or_remove_figure("sweep", "frequency", choice.output, wants_figures, common);
  draw_or_remove_figure("stages", "stages", choice.output, wants_figures && options.settings.stages, common);
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
  add_swept_options(*verb, options->choice);
  add_contestant_options(*verb, options->choice.contestants);
  verb->add_option(
          "--renderer", options->choice.contestants.renderer,
          "on: measures everything again while a second thread draws the scene at 90 Hz in its own context, as "
          "HAVE 2010 does")
      ->capture_default_str()
      ->check(CLI::IsMember({"on", "off"}));
  verb->add_option("--planes", options->choice.contestants.planes,
                   "Numbers of planes (render targets) that paper draws and reads back, 1 to 8, as 1,2,4,8 or 1:8")
      ->capture_default_str()
      ->type_name("LIST");
  verb->add_flag("--stages", options->settings.stages,
                 "Also measure where the time of a frame goes, in a pass of its own: pose, skinning, test, ...");
  add_measuring_options(*verb, options->choice, options->settings, "Consecutive frames at each place",
                        "Folder for sweep.json, the durations of frames, and the figures");
  verb->callback([options, &invocation] { run_sweep_verb(*options, invocation); });
}

}  // namespace vestige::cli
