#include "analysis/frequency/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/frequency/crowd_report.hpp"
#include "analysis/frequency/sweep_report.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/measure/sweep_choice.hpp"
#include "cli/verbs.hpp"
#include "detector/proofs/in_flight.hpp"
#include "traces/base/number_text.hpp"
#include "traces/mcap/compression.hpp"

namespace vestige::cli {

namespace {

/// Each needs detectors of its own, with all that they keep on the GPU.
constexpr std::uint32_t kMostPeople = 64;
/// Numbers of colliders beside --avatars: the paper's.
constexpr const char* kCrowdCounts = "40,100";
/// What fits side by side in the figure.
constexpr std::size_t kMostCrowdCounts = 3;

struct SweepOptions {
  SweepChoice choice = {{{}, "paper,cpu", "egl,osmesa", "on"}, "1:100"};
  SweepSettings settings;
  std::string avatars;
};

/// Returns the numbers of people that --avatars asks for, or none. Throws `UsageError` if flags do not go together.
std::vector<std::uint32_t> people_counts(const SweepOptions& options) {
  if (options.avatars.empty()) return {};
  std::vector<std::uint32_t> counts = parse_counts(options.avatars, "--avatars");
  if (counts.back() > kMostPeople)
    throw UsageError("--avatars",
                     fmt::format("asks for {} people; at most {} are measured", counts.back(), kMostPeople),
                     "ask for fewer");
  if (options.settings.counts.size() > kMostCrowdCounts)
    throw UsageError("--counts", fmt::format("has more than {} numbers, too many beside --avatars", kMostCrowdCounts),
                     fmt::format("leave it out for {}", kCrowdCounts));
  return counts;
}

/// Returns with each number of people a crowd in which all have colliders around them, and one in which only the first
/// has. Without numbers, it returns the people of the trace.
std::vector<Crowd> crowds_of(const std::vector<std::uint32_t>& counts, const SweepOptions& options,
                             const OpenTrace& trace) {
  const auto recorded = static_cast<std::uint32_t>(trace.people.size());
  if (options.choice.contestants.renderer == "on" && (recorded > 1 || !counts.empty()))
    throw UsageError("--renderer", "draws one person, and several are measured", "leave it out, or measure one person");
  if (counts.empty()) return {Crowd()};
  std::vector<Crowd> crowds;
  for (const std::uint32_t people : counts) {
    if (people % recorded != 0)
      throw UsageError(
          "--avatars",
          fmt::format("asks for {}, but all {} people of {} are copied", people, recorded, options.choice.trace),
          fmt::format("ask for multiples of {}", recorded));
    crowds.push_back({people / recorded, false});
    if (people > recorded) crowds.push_back({people / recorded, true});
  }
  return crowds;
}

/// Each contestant with each crowd.
std::vector<Contestant> with_crowds(const std::vector<Contestant>& contestants, const std::vector<Crowd>& crowds) {
  std::vector<Contestant> all;
  all.reserve(contestants.size() * crowds.size());
  for (const Contestant& contestant : contestants)
    for (const Crowd& crowd : crowds) all.emplace_back(contestant).crowd = crowd;
  return all;
}

/// The series' own GL first; the whole file's is that of the first series that has one.
nlohmann::ordered_json first_gl(std::span<const SweepSeries> series) {
  for (const SweepSeries& one : series)
    if (!one.gl.context.empty()) return to_json(one.gl);
  return nullptr;
}

void run_sweep_verb(SweepOptions& options, Invocation& invocation) {
  SweepChoice& choice = options.choice;
  if (!options.avatars.empty() && choice.counts_option->empty()) choice.counts = kCrowdCounts;
  const CommonOptions& common = choice.common;
  const Verbosity verbosity = common.verbosity();
  check_sweep_choice(choice, options.settings);
  const std::vector<std::uint32_t> counts = people_counts(options);
  const std::string json_path = choice.output + "/sweep.json";
  const std::string times_path = choice.output + "/frame_times.csv.zst";
  const std::string path =
      prepare_sweep(choice, {json_path, times_path}, std::ranges::max(options.settings.counts), invocation);
  OpenTrace trace(path, verbosity, People::kSeveral);
  const std::vector<Crowd> crowds = crowds_of(counts, options, trace);
  leave_out_missing_colliders(choice, trace.reader.collider_ids().size(), options.settings);
  const std::vector<Contestant> contestants = with_crowds(make_contestants(choice.contestants, verbosity), crowds);
  std::vector<SweptPerson> people;
  people.reserve(trace.people.size());
  for (const TracedPerson& person : trace.people) people.push_back({person.avatar, person.map});
  std::set<std::string> names;
  for (const Contestant& contestant : contestants) names.insert(contestant.detector);
  warn_of_radii({names.begin(), names.end()}, trace.reader, path, verbosity);
  Sweep sweep;
  {
    Progress progress("Measuring", verbosity);
    sweep = run_sweep(trace.reader, people, survey_maker(choice.contestants), contestants, options.settings,
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
  const bool crowded = has_crowds(series);
  print_summary((crowded ? crowd_table(series, options.settings.seed) : sweep_table(series, options.settings.seed)) +
                    sample_sentence(sweep),
                {common.json}, common);
  print_summary(fmt::format("written: {}, {}\n", json_path, times_path), {common.json}, common);
  const bool wants_figures = !choice.no_figure && !interrupted();
  draw_or_remove_figure("sweep", "frequency", choice.output, wants_figures && !crowded, common);
  draw_or_remove_figure("sweep", "people", choice.output, wants_figures && crowded, common);
  draw_or_remove_figure("stages", "stages", choice.output, wants_figures && options.settings.stages && !crowded,
                        common);
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
  verb->add_option("--avatars", options->avatars,
                   "Numbers of people, as 1,2,4 or 1:8: measures that many copies of the trace's people, side by side, "
                   "each with as many colliders, then with colliders around the first only; --counts is then 40,100")
      ->type_name("LIST");
  verb->add_flag("--stages", options->settings.stages,
                 "Also measure where the time of a frame goes, in a pass of its own: pose, skinning, test, ...");
  verb->add_option("--in-flight", options->settings.in_flight,
                   "Also measure throughput, as long again: frames are given to each detector K at a time, and GPUs "
                   "work on several at once; the frequency itself stays that of one frame after another, as in the "
                   "paper")
      ->check(help::whole_number(1, kMostInFlight))
      ->type_name("K");
  add_measuring_options(*verb, options->choice, options->settings, "Consecutive frames at each place",
                        "Folder for sweep.json, the durations of frames, and the figures");
  verb->callback([options, &invocation] { run_sweep_verb(*options, invocation); });
}

}  // namespace vestige::cli
