#include "cli/measure/sweep_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "cli/help/validators.hpp"
#include "cli/measure/default_trace.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

constexpr std::uint32_t kMostColliders = 1'000'000;  // as many as --count takes

}  // namespace

void add_swept_options(CLI::App& verb, SweepChoice& choice) {
  verb.add_option("TRACE", choice.trace, "The trace to measure on [default: the built-in avatar in a swarm]");
  choice.counts_option =
      verb.add_option("--counts", choice.counts,
                      "Numbers of colliders, drawn at random from the trace's, as 1,10,40,100 or 1:100 or 5:100:5")
          ->capture_default_str()
          ->type_name("LIST");
}

void add_measuring_options(CLI::App& verb, SweepChoice& choice, SweepSettings& settings,
                           const std::string& run_frames_help, const std::string& output_help) {
  verb.add_option("--runs", settings.runs,
                  "Number of evenly spread places in the trace to measure at, each with other colliders")
      ->capture_default_str()
      ->check(help::whole_number(1, 10000));
  verb.add_option("--run-frames", settings.run_frames, run_frames_help)
      ->capture_default_str()
      ->check(help::whole_number(1, 100000));
  verb.add_option("--min-time", settings.min_time_s, "Least time to measure every point, in seconds")
      ->capture_default_str()
      ->check(help::kPositive)
      ->type_name("S");
  verb.add_flag("--no-figure", choice.no_figure, "Do not draw the figure");
  verb.add_option("-o,--output", choice.output, output_help)->required()->type_name("DIR");
  add_common_options(verb, choice.common);
}

void check_sweep_choice(const SweepChoice& choice, SweepSettings& settings) {
  settings.counts = parse_counts(choice.counts, "--counts");
  if (settings.counts.back() > kMostColliders)
    throw UsageError("--counts", fmt::format("{} colliders are too many", settings.counts.back()),
                     fmt::format("choose at most {}", kMostColliders));
  settings.seed = choice.common.seed;
  check_contestant_choice(choice.contestants);
}

void leave_out_missing_colliders(const SweepChoice& choice, std::size_t colliders, SweepSettings& settings) {
  if (!choice.counts_option->empty() || colliders == 0) return;
  std::erase_if(settings.counts, [&](std::uint32_t count) { return count > colliders; });
  if (settings.counts.empty()) settings.counts = {static_cast<std::uint32_t>(colliders)};
}

std::string prepare_sweep(const SweepChoice& choice, std::vector<std::string> results, std::uint32_t colliders,
                          const Invocation& invocation) {
  std::string new_trace = choice.trace.empty() ? choice.output + "/trace.mcap" : "";
  results.push_back(new_trace);
  results.push_back(choice.common.json);
  make_output_folder(choice.output);
  check_outputs(results, {choice.trace}, choice.common);
  catch_interrupts();
  if (new_trace.empty()) return choice.trace;
  record_default_trace(new_trace, {colliders}, choice.common, invocation);
  return new_trace;
}

void check_measured(const std::string& verb, std::span<const SweepSeries> series) {
  const bool nothing = std::ranges::all_of(series, [](const SweepSeries& one) {
    return std::ranges::all_of(one.points, [](const SweepPoint& point) { return point.repetitions.empty(); });
  });
  if (nothing) throw Error(verb, "was stopped before anything had been measured", "start it again");
}

}  // namespace vestige::cli
