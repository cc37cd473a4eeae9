#include "analysis/frequency/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "analysis/base/provenance.hpp"
#include "analysis/frequency/growth_report.hpp"
#include "analysis/frequency/sweep_report.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/measure/default_trace.hpp"
#include "cli/measure/sweep_choice.hpp"
#include "cli/verbs.hpp"

namespace vestige::cli {

namespace {

/// Four times each: five subdivisions of the built-in avatar have 5 million triangles.
constexpr std::uint32_t kMostSubdivisions = 5;

/// A longer trace with more colliders would fill the disk: 100 000 of them need 1.3 MB a frame.
constexpr std::uint32_t kMostForLongTrace = 1000;
constexpr double kCrowdedDuration_s = 0.05;

struct GrowthOptions {
  SweepChoice choice = {{{}, "paper,geometry,compute,cpu,embree", "auto", "off,on"},
                        "1,3,10,30,100,300,1000,3000,10000,30000,100000"};
  GrowthSettings settings;
};

/// A subdivided avatar and another number of colliders change the contacts, but for all that promise the same alike.
std::vector<std::string> all_disagreements(const Growth& growth) {
  std::vector<std::string> found = disagreements(growth.by_colliders);
  for (const GrowthSize& size : growth.by_triangles)
    for (const std::string& sentence : disagreements(size.series))
      found.push_back(fmt::format("{} triangles: {}", size.triangles, sentence));
  return found;
}

/// What is measured: TRACE, or traces that are recorded into the folder of the results.
class MeasuredTraces {
 public:
  MeasuredTraces(const GrowthOptions& options, const std::string& json_path, const Invocation& invocation)
      : options_(options),
        most_(std::max(std::ranges::max(options.settings.sweep.counts), options.settings.colliders)),
        path_(
            prepare_sweep(options.choice, {json_path, crowded_path()}, std::min(most_, kMostForLongTrace), invocation)),
        usual_(path_, options.choice.common.verbosity()) {
    if (crowded_path().empty()) return;
    record_default_trace(crowded_path(), {most_, kCrowdedDuration_s}, options.choice.common, invocation);
    crowded_.emplace(crowded_path(), options.choice.common.verbosity());
  }

  const std::string& path() const { return path_; }
  /// Empty if one trace has enough colliders, and if TRACE is all there is.
  std::string crowded_path() const {
    return options_.choice.trace.empty() && most_ > kMostForLongTrace ? options_.choice.output + "/crowded.mcap" : "";
  }
  OpenTrace& usual() { return usual_; }
  GrowthTraces readers() { return {usual_.reader, crowded_ ? crowded_->reader : usual_.reader}; }

 private:
  const GrowthOptions& options_;
  std::uint32_t most_;
  std::string path_;
  OpenTrace usual_;
  std::optional<OpenTrace> crowded_;
};

/// Throws `Error` if no trace has the colliders that --count asks for.
void check_count(const GrowthOptions& options, std::size_t colliders) {
  if (colliders < options.settings.colliders)
    throw Error("--count",
                fmt::format("{} colliders are asked for, and the trace has {}", options.settings.colliders, colliders),
                "ask for fewer, or record a trace with more");
}

void run_growth_verb(GrowthOptions& options, Invocation& invocation) {
  const SweepChoice& choice = options.choice;
  const CommonOptions& common = choice.common;
  const Verbosity verbosity = common.verbosity();
  SweepSettings& sweep = options.settings.sweep;
  check_sweep_choice(choice, sweep);
  const std::string json_path = choice.output + "/growth.json";
  MeasuredTraces traces(options, json_path, invocation);
  const OpenTrace& trace = traces.usual();
  const std::size_t colliders = traces.readers().crowded.collider_ids().size();
  leave_out_missing_colliders(choice, colliders, sweep);
  check_count(options, colliders);
  Growth growth;
  {
    Progress progress("Measuring", verbosity);
    growth = run_growth(traces.readers(), {trace.person().avatar, trace.person().map}, survey_maker(choice.contestants),
                        make_contestants(choice.contestants, verbosity), options.settings,
                        [&](double share) { return progress.update(share); });
  }
  check_measured("growth", growth.by_colliders);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["avatar"] = to_json(trace.person().avatar);
  json["trace"] = traces.path();
  json["crowded_trace"] =
      traces.crowded_path().empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(traces.crowded_path());
  json["complete"] = !interrupted();
  json["colliders"] = options.settings.colliders;
  json.update(to_json(growth, sweep.seed));
  write_json(json_path, json, common);
  write_json(common.json, json, common);

  if (interrupted()) warn("stopped early; the results so far were written, and no figure is drawn", verbosity);
  for (const std::string& warning : noise_warnings(growth.by_colliders)) warn(warning, verbosity);
  const std::vector<std::string> wrong = all_disagreements(growth);
  for (const std::string& warning : wrong) warn(warning, verbosity);
  print_summary(growth_table(growth, options.settings.colliders), {common.json}, common);
  print_summary(fmt::format("written: {}\n", json_path), {common.json}, common);
  draw_or_remove_figure("growth", "growth", choice.output, !choice.no_figure && !interrupted(), common);
  invocation.exit_code = report_damage(trace.reader, traces.path(), verbosity);
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
  add_swept_options(*verb, options->choice);
  verb->add_option("--count", options->settings.colliders, "Number of colliders for every size of the avatar")
      ->capture_default_str()
      ->check(help::whole_number(1, 1000000));
  verb->add_option("--subdivisions", options->settings.subdivisions,
                   "How many times the avatar's triangles are split into four; each size is measured")
      ->capture_default_str()
      ->check(help::whole_number(0, kMostSubdivisions));
  verb->add_option("--frame-limit", options->settings.frame_limit_s,
                   "Leave a detector out of larger sizes once its mean frame takes longer, in seconds")
      ->capture_default_str()
      ->check(help::kPositive)
      ->type_name("S");
  add_contestant_options(*verb, options->choice.contestants);
  add_measuring_options(*verb, options->choice, options->settings.sweep,
                        fmt::format("Consecutive frames at each place; above {} pairs of collider and triangle, single "
                                    "frames at 3 places",
                                    kManyPairs),
                        "Folder for growth.json and the figure");
  verb->callback([options, &invocation] { run_growth_verb(*options, invocation); });
}

}  // namespace vestige::cli
