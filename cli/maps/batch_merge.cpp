#include "analysis/batch/batch_merge.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>

#include "analysis/base/provenance.hpp"
#include "analysis/batch/batch_record.hpp"
#include "analysis/batch/batch_results.hpp"
#include "analysis/batch/rank_by.hpp"
#include "cli/maps/batch_options.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::cli {

namespace {

struct BatchMergeOptions {
  CommonOptions common;
  std::vector<std::string> folders;
  std::string rank_by;
  std::string output;
};

void copy_file(const std::filesystem::path& from, const std::string& to) {
  write_or_remove_file(to, std::filesystem::exists(from) ? read_text_file(from) : "");
}

/// The files of each trace, and those of the whole batch, which every shard has.
void copy_files(const MergedShards& shards, const BatchFolder& folder) {
  const std::filesystem::path first = shards.first_folder;
  copy_file(first / "avatar.glb", folder.top("avatar.glb"));
  copy_file(first / "actuator.json", folder.top("actuator.json"));
  for (const nlohmann::ordered_json& map : shards.batch["maps"]) {
    const auto name = map["name"].get<std::string>();
    copy_file(first / ("maps/" + name + ".png"), folder.map_png(name));
    copy_file(first / ("maps/" + name + ".json"), folder.map_json(name));
  }
  for (std::size_t i = 0; i < shards.folder_of_trace.size(); ++i) {
    const std::filesystem::path from = shards.folder_of_trace[i];
    if (from.empty()) continue;
    const auto name = shards.batch["traces"][i]["name"].get<std::string>();
    copy_file(from / ("contacts/" + name + ".csv"), folder.contacts(name));
    copy_file(from / ("traces/" + name + ".mcap"), folder.trace(name));
    copy_file(from / ("times/" + name + ".json"), folder.item_times(name));
    copy_file(from / ("items/" + name + ".json"), folder.item(name));
  }
}

/// What the shards' run.json say of each trace, in the order of the batch.
nlohmann::ordered_json traces_of(const MergedShards& shards) {
  std::map<std::string, nlohmann::ordered_json> records;
  for (const nlohmann::ordered_json& run : shards.runs)
    for (const nlohmann::ordered_json& record : run["traces"]) records.try_emplace(record.value("name", ""), record);
  nlohmann::ordered_json traces = nlohmann::ordered_json::array();
  for (const nlohmann::ordered_json& trace : shards.batch["traces"])
    if (const auto found = records.find(trace["name"].get<std::string>()); found != records.end())
      traces.push_back(found->second);
  return traces;
}

nlohmann::ordered_json run_of(const MergedShards& shards, const Invocation& invocation, const std::string& rank_by) {
  nlohmann::ordered_json run = provenance(invocation.argv);
  run["batch"] = shards.batch;
  run["shard"] = {{"number", 1}, {"count", 1}};
  run["rank_by"] = rank_by;
  run["complete"] = false;
  for (const char* field : {"avatar", "maps"})  // the same in every shard
    if (shards.runs.front().contains(field)) run[field] = shards.runs.front()[field];
  run["merged"] = nlohmann::ordered_json::array();
  for (const nlohmann::ordered_json& shard : shards.runs) {
    nlohmann::ordered_json one;
    for (const char* field : {"shard", "argv", "time", "machine", "jobs", "wall_s"})
      one[field] = shard.contains(field) ? shard[field] : nullptr;
    run["merged"].push_back(one);
  }
  run["traces"] = traces_of(shards);
  run["failures"] = shards.failures;
  std::size_t maps = 0;
  for (const nlohmann::ordered_json& map : shards.batch["maps"]) maps += map["sha256"].is_null() ? 0U : 1U;
  run["totals"] = totals(run["traces"], maps * shards.batch["laws"].size());
  return run;
}

void run_merge_shards(const BatchMergeOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_outputs({options.common.json}, {}, options.common);
  if (options.output == "-") throw UsageError("-o -", "a batch is a folder of files", "name a folder");
  for (const std::string& folder : options.folders) {
    std::error_code missing;
    if (std::filesystem::equivalent(folder, options.output, missing))
      throw UsageError("-o", fmt::format("'{}' is one of the shards", options.output), "choose another folder");
  }
  catch_interrupts();
  const MergedShards shards = read_shards(options.folders);
  if (shards.items.empty())
    throw Error("merge", "none of the traces could be used", "read the causes in the shards' run.json");
  const std::string rank_by = options.rank_by.empty() ? shards.rank_by : options.rank_by;
  const std::size_t headline = headline_of(rank_by);
  const BatchFolder folder(options.output, shards.batch, {1, 1},
                           options.common.force ? OtherBatch::kReplace : OtherBatch::kRefuse);
  nlohmann::ordered_json run = run_of(shards, invocation, rank_by);
  folder.remove_results(run);
  write_json_file(folder.top("run.json"), run);
  copy_files(shards, folder);
  const BatchResults results = write_results(folder, shards.batch, shards.items, headline);
  run["complete"] = true;
  write_json_file(folder.top("run.json"), run);

  warn_of_inputs(run, verbosity);
  for (const std::string& warning : results.warnings) warn(warning, verbosity);
  for (const nlohmann::ordered_json& failure : shards.failures) {
    warn(fmt::format("{} '{}' is left out: {}\n  {}", failure.value("what", ""), failure.value("name", ""),
                     failure.value("cause", ""), failure.value("remedy", "")),
         verbosity);
    invocation.exit_code = kDataLost;
  }
  for (const nlohmann::ordered_json& item : shards.items) {
    for (const std::string& loss : losses_of(item)) {
      warn(loss, verbosity);
      invocation.exit_code = kDataLost;
    }
  }
  const std::string merged = fmt::format("merged {}: {}, {}\nwritten: {}\n", counted(shards.runs.size(), "shard"),
                                         counted(shards.items.size(), "trace"),
                                         counted(run["totals"]["scores"].get<std::size_t>(), "score"), options.output);
  print_summary(describe(results, kRowsShown) + merged, {options.common.json}, options.common);
  run["ranking"] = read_json_object(folder.top("ranking.json"), "");
  write_json(options.common.json, run, options.common);
}

}  // namespace

void add_batch_merge(CLI::App& batch, Invocation& invocation) {
  auto options = std::make_shared<BatchMergeOptions>();
  CLI::App* verb =
      add_verb(batch, "merge", "Merge the shards of one batch: byte for byte the results of an unsplit batch",
               "  vestige batch merge part1 part2 -o whole\n"
               "  vestige batch merge part* -o whole --json whole.json\n");
  verb->add_option("DIR", options->folders, "The folders of all shards, in any order")->required();
  add_rank_by(*verb, options->rank_by)
      ->description("The metric that ranks maps and laws [default: the shards' metric]");
  verb->add_option("-o,--output", options->output, "Folder for the results")->required()->type_name("OUT");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_merge_shards(*options, invocation); });
}

}  // namespace vestige::cli
