#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "analysis/base/provenance.hpp"
#include "analysis/batch/batch_inputs.hpp"
#include "analysis/batch/batch_record.hpp"
#include "analysis/batch/batch_results.hpp"
#include "analysis/batch/batch_run.hpp"
#include "analysis/batch/rank_by.hpp"
#include "analysis/scoring/contact_recording.hpp"
#include "cli/choices/motion.hpp"
#include "cli/help/validators.hpp"
#include "cli/maps/batch_options.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

struct BatchRunOptions {
  BatchOptions batch;
  std::size_t jobs = 0;
  std::string shard = "1/1";
};

Shard parse_shard(const std::string& text, std::size_t traces) {
  Shard shard = {0, 0};
  const char* end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto count = slash ? std::from_chars(number.ptr + 1, end, shard.count) : number;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.number < 1 || shard.number > shard.count)
    throw UsageError("--shard", fmt::format("'{}' is not I/N with I from 1 to N", text),
                     "give 1/4, 2/4, 3/4 and 4/4 for four parts");
  if (shard.count > traces)
    throw UsageError("--shard",
                     fmt::format("{} for {}: some shards would have no trace", counted(shard.count, "shard"),
                                 counted(traces, "trace")),
                     fmt::format("make at most {}", counted(traces, "shard")));
  return shard;
}

/// The inputs' own bytes, so that the folder can be looked at and drawn without the inputs.
void write_inputs(const BatchPlan& plan, const BatchFolder& folder) {
  write_file(folder.top("avatar.glb"), {reinterpret_cast<const char*>(plan.avatar_glb.data()), plan.avatar_glb.size()});
  write_or_remove_file(folder.top("actuator.json"), plan.actuators.json);
  for (const BatchMap& map : plan.maps) {
    if (map.sha256.empty()) continue;
    write_file(folder.map_png(map.name), {reinterpret_cast<const char*>(map.files.png.data()), map.files.png.size()});
    write_or_remove_file(folder.map_json(map.name), map.files.json);
  }
}

struct BatchReport {
  nlohmann::ordered_json run;
  bool lost = false;
};

/// run.json of a batch that has ended. Warns of what was lost.
BatchReport report(const BatchPlan& plan, const BatchFolder& folder, const BatchOutcome& outcome,
                   const std::vector<BatchFailure>& failures, nlohmann::ordered_json run, Verbosity verbosity) {
  run["complete"] = !outcome.interrupted;
  run["traces"] = nlohmann::ordered_json::array();
  BatchReport report;
  for (const BatchItem& item : outcome.items) {
    run["traces"].push_back(trace_record(plan.traces[item.trace], item.result, folder, item.earlier));
    for (const std::string& loss : losses_of(item.result)) {
      warn(loss, verbosity);
      report.lost = true;
    }
  }
  run["failures"] = nlohmann::ordered_json::array();
  for (const BatchFailure& failure : failures) {
    run["failures"].push_back(to_json(failure));
    warn(fmt::format("{} '{}' is left out: {}\n  {}", failure.what, failure.name, failure.cause, failure.remedy),
         verbosity);
    report.lost = true;
  }
  const auto usable = std::ranges::count_if(plan.maps, [](const BatchMap& map) { return !map.sha256.empty(); });
  run["totals"] = totals(run["traces"], static_cast<std::size_t>(usable) * plan.laws.size());
  report.run = std::move(run);
  return report;
}

std::string summary(const BatchOutcome& outcome, const nlohmann::ordered_json& run, const std::string& folder) {
  const auto earlier = static_cast<std::size_t>(std::ranges::count_if(outcome.items, &BatchItem::earlier));
  const nlohmann::ordered_json& totals = run["totals"];
  const std::size_t detected = outcome.items.size() - earlier;
  const nlohmann::ordered_json& options = run["batch"]["options"];
  const std::string by = options.value("approximate", false)
                             ? fmt::format(" by {} (approximate)", options["detector"].get<std::string>())
                             : "";
  std::string text = fmt::format("detected {} once{}, {}", counted(detected, "trace"), by,
                                 counted(totals["scores"].get<std::size_t>(), "score"));
  if (earlier != 0) text += fmt::format(" ({} finished by an earlier run)", counted(earlier, "trace"));
  text += fmt::format(
      "\nprocessor time: reading {:.2f} s, detecting {:.2f} s, all maps and laws {:.2f} s; {:.2f} s with {}\n",
      totals["reading_s"].get<double>(), totals["detection_s"].get<double>(), totals["scoring_s"].get<double>(),
      run["wall_s"].get<double>(), counted(run["jobs"].get<std::size_t>(), "job"));
  if (!run["failures"].empty()) {
    text += "left out:\n";
    for (const nlohmann::ordered_json& failure : run["failures"])
      text += fmt::format("  {} {}: {}; {}\n", failure["what"].get<std::string>(), failure["name"].get<std::string>(),
                          failure["cause"].get<std::string>(), failure["remedy"].get<std::string>());
  }
  return text + fmt::format("written: {}\n", folder);
}

/// Shows progress, and with -v each tenth of a second's news as a line, for logs.
class BatchWatch {
 public:
  explicit BatchWatch(Verbosity verbosity)
      : bar_("Batch", verbosity), verbosity_(verbosity), start_(std::chrono::steady_clock::now()) {}

  bool update(const BatchProgress& now) {
    if (verbosity_ == Verbosity::kVerbose && now.finished != told_) {
      told_ = now.finished;
      const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
      print_message(fmt::format("vestige: {} of {} traces, about {:.0f} s left\n", now.finished, now.traces,
                                now.share > 0 ? spent_s * (1 - now.share) / now.share : 0));
    }
    return bar_.update(now.share);
  }

 private:
  Progress bar_;
  Verbosity verbosity_;
  std::chrono::steady_clock::time_point start_;
  std::size_t told_ = 0;
};

/// run.json of a batch that begins.
nlohmann::ordered_json begun_record(const nlohmann::ordered_json& identity, const Shard& shard, std::size_t jobs,
                                    const BatchOptions& batch, const Invocation& invocation) {
  nlohmann::ordered_json run = provenance(invocation.argv);
  run["batch"] = identity;
  run["shard"] = {{"number", shard.number}, {"count", shard.count}};
  run["rank_by"] = rank_by_of(batch);
  run["complete"] = false;
  run["jobs"] = jobs;
  return run;
}

BatchOutcome detect(const BatchPlan& plan, const Shard& shard, const BatchFolder& folder, std::size_t jobs,
                    const BatchOptions& batch) {
  const ActuatorMap no_map;  // contacts are recorded for all maps at once
  BatchWatch watch(batch.common.verbosity());
  return run_batch(
      plan, shard, folder, jobs,
      [&] {
        return make_detector(plan.detector, batch.choice.context, batch.choice, plan.avatar, no_map, kRecordedPlanes);
      },
      [&](const BatchProgress& now) { return watch.update(now); });
}

void run_batch_verb(const BatchRunOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  const BatchOptions& batch = options.batch;
  const Verbosity verbosity = batch.common.verbosity();
  BatchPlan plan = plan_of(batch);
  const Shard shard = parse_shard(options.shard, plan.traces.size());
  const std::size_t headline = headline_of(rank_by_of(batch));
  check_outputs({batch.common.json}, batch.traces, batch.common);
  if (plan.has_scenario())
    warn_of_frame_count(plan.recording.rate_hz * plan.recording.duration_s,
                        "Ctrl-C stops the batch, and the same command then continues after the last finished trace",
                        verbosity);
  catch_interrupts();
  const std::size_t jobs = options.jobs != 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  std::vector<BatchFailure> failures =
      load_inputs(plan, batch.avatar, batch.maps, batch.law_parameters.actuator, jobs, [] { return !interrupted(); });
  if (failures.size() == plan.maps.size())
    throw Error("--maps", fmt::format("none of the maps can be used: {}", failures.front().cause),
                failures.front().remedy);
  if (plan.has_scenario()) choose_animation(plan.avatar, "", batch.morphs, verbosity);  // which is what they play

  const nlohmann::ordered_json identity = to_json(plan);
  const BatchFolder folder(batch.output, identity, shard,
                           batch.common.force ? OtherBatch::kReplace : OtherBatch::kRefuse);
  nlohmann::ordered_json run = begun_record(identity, shard, jobs, batch, invocation);
  run.update(input_warnings(plan));
  warn_of_inputs(run, verbosity);
  folder.remove_results(run);                    // which may be another batch's
  write_json_file(folder.top("run.json"), run);  // before the first item, so that the folder is known as this batch's
  write_inputs(plan, folder);

  const BatchOutcome outcome = detect(plan, shard, folder, jobs, batch);
  failures.insert(failures.end(), outcome.failures.begin(), outcome.failures.end());
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  run["wall_s"] = spent.count();
  const BatchReport ended = report(plan, folder, outcome, failures, std::move(run), verbosity);
  folder.remove_results(ended.run);
  if (outcome.interrupted) {
    write_json_file(folder.top("run.json"), ended.run);
    warn(fmt::format("stopped; {} finished, and the same command continues from there",
                     counted(outcome.items.size(), "trace")),
         verbosity);
    write_json(batch.common.json, ended.run, batch.common);
    invocation.exit_code = kDataLost;
    return;
  }
  if (outcome.items.empty()) {
    write_json_file(folder.top("run.json"), ended.run);
    if (shard.count > 1) {  // the others may do better, and are merged with it
      warn(fmt::format("shard {}/{}: none of the shard's traces could be used", shard.number, shard.count), verbosity);
      print_summary(summary(outcome, ended.run, batch.output), {batch.common.json}, batch.common);
      write_json(batch.common.json, ended.run, batch.common);
      invocation.exit_code = kDataLost;
      return;
    }
    throw Error("--traces", "none of the traces could be used",
                "read the causes in the warnings above, or in run.json");
  }
  std::vector<nlohmann::ordered_json> items;
  for (const BatchItem& item : outcome.items) items.push_back(item.result);
  const BatchResults results = write_results(folder, identity, items, headline);
  write_json_file(folder.top("run.json"), ended.run);  // last: "complete" says that all is there

  for (const std::string& warning : results.warnings) warn(warning, verbosity);
  print_summary(describe(results, kRowsShown) + summary(outcome, ended.run, batch.output), {batch.common.json},
                batch.common);
  nlohmann::ordered_json json = ended.run;
  json["ranking"] = read_json_object(folder.top("ranking.json"), "");
  write_json(batch.common.json, json, batch.common);
  if (ended.lost) invocation.exit_code = kDataLost;
}

}  // namespace

void add_batch(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<BatchRunOptions>();
  CLI::App* verb =
      add_verb(program, "batch", "Compare actuator maps and intensity laws over many traces",
               "  vestige batch --maps paper6 torso16 torso40 body --traces swarm hug slide --seeds 1:20 -o compared\n"
               "  vestige batch --maps builtin regions.png --traces man.mcap --laws binary,phantom -o judged\n");
  add_batch_options(*verb, options->batch);
  verb->add_option("--jobs", options->jobs,
                   "How many traces are processed at the same time, each on one core [default: all cores]")
      ->check(help::whole_number(1, 1024))
      ->type_name("N");
  verb->add_option("--shard", options->shard,
                   "Run only each N-th trace, from the I-th; 'vestige batch merge' puts the shards together")
      ->capture_default_str()
      ->type_name("I/N");
  verb->require_subcommand(0, 1);
  add_batch_merge(*verb, invocation);
  add_batch_slurm(*verb, invocation);
  // What the batch itself must be given is not asked for where only its parts are handled, and would do nothing there.
  for (CLI::App* part : verb->get_subcommands([](CLI::App*) { return true; })) {
    part->preparse_callback([verb, part](std::size_t) {
      for (CLI::Option* option : verb->get_options()) {
        if (option->count() != 0)
          throw UsageError(
              option->get_name(), fmt::format("must not stand before '{}'", part->get_name()),
              fmt::format("give the flag after '{0}'; if '{0}' is a file, write './{0}'", part->get_name()));
        option->required(false);
      }
    });
  }
  verb->callback([verb, options, &invocation] {
    if (verb->get_subcommands().empty()) run_batch_verb(*options, invocation);
  });
}

}  // namespace vestige::cli
