#include "analysis/batch/batch_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "analysis/base/results_folder.hpp"
#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/batch_plan.hpp"
#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kRemedy = "name folders that 'vestige batch --shard I/N' wrote";

struct ShardFolder {
  std::string folder;
  Shard shard;
  nlohmann::ordered_json run;

  std::string path(std::string_view name) const { return (std::filesystem::path(folder) / name).string(); }
};

ShardFolder read_shard(const std::string& folder) {
  ShardFolder shard = {folder, {}, {}};
  const std::string path = shard.path("run.json");
  require_folder(folder, kRemedy);
  if (!std::filesystem::exists(path)) throw Error(folder, "contains no batch (no run.json)", kRemedy);
  shard.run = read_json_object(path, kRemedy);
  try {
    shard.shard = {shard.run.at("shard").at("number"), shard.run.at("shard").at("count")};
    if (shard.shard.number < 1 || shard.shard.number > shard.shard.count)
      throw Error(path, "has a shard number that is not from 1 to the number of shards", kRemedy);
    if (!shard.run.at("complete").get<bool>())
      throw Error(folder, "is not finished", "run its command again: it continues where it stopped; then merge");
    if (!shard.run.at("batch").at("traces").is_array() || !shard.run.at("failures").is_array())
      throw Error(path, "is not the run.json of a batch", kRemedy);
    static_cast<void>(item_key(shard.run.at("batch")));
    static_cast<void>(shard.run.at("rank_by").get<std::string>());
  } catch (const nlohmann::json::exception&) {
    throw Error(path, "is not the run.json of a batch", kRemedy);
  }
  return shard;
}

/// Returns the fields in which two batches differ.
std::string difference(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b) {
  std::vector<std::string> names;
  for (const auto& [name, value] : a.items())
    if (!b.contains(name) || b[name] != value) names.push_back(name == "program" ? "program version" : name);
  return fmt::format("{}", fmt::join(names, ", "));
}

void check_same_batch(const std::vector<ShardFolder>& shards) {
  const ShardFolder& first = shards.front();
  for (const ShardFolder& shard : shards) {
    if (shard.run["batch"] != first.run["batch"])
      throw Error(shard.folder,
                  fmt::format("belongs to another batch than '{}': they differ in {}", first.folder,
                              difference(first.run["batch"], shard.run["batch"])),
                  "merge the shards of one batch, run with the same program on the same files");
    if (shard.shard.count != first.shard.count)
      throw Error(
          shard.folder,
          fmt::format("is one of {} shards, but '{}' is one of {}", shard.shard.count, first.folder, first.shard.count),
          "merge shards of the same --shard I/N");
  }
  if (first.run["batch"]["program"] != program_version())
    throw Error(first.folder,
                fmt::format("was written by version {}, but this is version {}",
                            first.run["batch"]["program"].get<std::string>(), program_version()),
                "merge with the program that ran the shards");
}

void check_none_missing(const std::vector<ShardFolder>& shards) {
  std::set<std::size_t> there;
  for (const ShardFolder& shard : shards) there.insert(shard.shard.number);
  std::vector<std::string> missing;
  const std::size_t count = shards.front().shard.count;
  for (std::size_t number = 1; number <= count; ++number)
    if (!there.contains(number)) missing.push_back(fmt::format("{}/{}", number, count));
  if (!missing.empty())
    throw Error("merge",
                fmt::format("shard{} {} {} missing", missing.size() == 1 ? "" : "s", fmt::join(missing, ", "),
                            missing.size() == 1 ? "is" : "are"),
                "run them, then name their folders too");
}

bool failed(const ShardFolder& shard, const std::string& trace) {
  return std::ranges::any_of(shard.run["failures"], [&](const nlohmann::ordered_json& failure) {
    return failure.value("what", "") == "trace" && failure.value("name", "") == trace;
  });
}

/// Returns the item of a trace in its folder, or nothing if the trace failed there. Throws `Error` if the item is
/// missing.
std::optional<nlohmann::ordered_json> item_in(const ShardFolder& shard, const std::string& trace) {
  const std::string path = shard.path("items/" + trace + ".json");
  if (!std::filesystem::exists(path)) {
    if (failed(shard, trace)) return std::nullopt;
    throw Error(path, "is missing", "run the shard's command again: it writes this file");
  }
  const std::string contacts = shard.path("contacts/" + trace + ".csv");
  if (!std::filesystem::exists(contacts))
    throw Error(contacts, "is missing", "run the shard's command again: it writes this file");
  nlohmann::ordered_json item = read_json_object(path, "run the shard's command again");
  if (!item.contains("key") || item["key"] != item_key(shard.run["batch"]))
    throw Error(path, "does not match run.json: the maps, laws, options or the program differ",
                "run the shard's command again");
  if (!item.contains("contacts_sha256") || item["contacts_sha256"] != sha256_of_file(contacts))
    throw Error(contacts, "is not the file that its batch wrote: the SHA-256 differs",
                "run the shard's command again: it writes this file again");
  return item;
}

/// Avatar, motors and maps are copied from one folder for all shards. Checks that they are still what that shard
/// judged.
void check_inputs(const ShardFolder& shard) {
  const auto check = [&](const char* what, const std::vector<std::string>& files, const nlohmann::ordered_json& of) {
    if (!of.is_object() || of.at("sha256").is_null()) return;  // ideal motors, or a map that could not be used
    Sha256 sha;
    for (const std::string& file : files)
      if (const std::string path = shard.path(file); std::filesystem::exists(path)) sha.update(read_file(path));
    if (of.at("sha256") != sha.hex())
      throw Error(shard.path(files.front()) + what,
                  "is missing, or is not the file that the batch scored: the SHA-256 differs",
                  "run the shard's command again: it writes this file again");
  };
  const nlohmann::ordered_json& batch = shard.run["batch"];
  check("", {"avatar.glb"}, batch["avatar"]);
  check("", {"actuator.json"}, batch["options"].value("actuator", nlohmann::ordered_json()));
  for (const nlohmann::ordered_json& map : batch["maps"]) {
    const std::string file = "maps/" + map["name"].get<std::string>();
    check(" or its sidecar", {file + ".png", file + ".json"}, map);
  }
}

void add_failures(const std::vector<ShardFolder>& shards, MergedShards& merged) {
  std::map<std::pair<std::string, std::string>, nlohmann::ordered_json> by_name;
  for (const ShardFolder& shard : shards)
    for (const nlohmann::ordered_json& failure : shard.run["failures"])
      by_name.try_emplace({failure.value("what", ""), failure.value("name", "")}, failure);
  merged.failures = nlohmann::ordered_json::array();
  for (const auto& [what, list] : {std::pair("map", "maps"), std::pair("trace", "traces")})
    for (const nlohmann::ordered_json& one : merged.batch[list])
      if (const auto found = by_name.find({what, one["name"].get<std::string>()}); found != by_name.end())
        merged.failures.push_back(found->second);
}

}  // namespace

MergedShards read_shards(const std::vector<std::string>& folders) {
  std::vector<ShardFolder> shards;
  shards.reserve(folders.size());
  for (const std::string& folder : folders) shards.push_back(read_shard(folder));
  check_same_batch(shards);
  check_none_missing(shards);
  std::ranges::stable_sort(shards, {}, [](const ShardFolder& shard) { return shard.shard.number; });
  check_inputs(shards.front());

  MergedShards merged;
  merged.batch = shards.front().run["batch"];
  merged.first_folder = shards.front().folder;
  merged.rank_by = shards.front().run["rank_by"].get<std::string>();
  for (const ShardFolder& shard : shards) merged.runs.push_back(shard.run);
  const nlohmann::ordered_json& traces = merged.batch["traces"];
  merged.folder_of_trace.resize(traces.size());
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto name = traces[i]["name"].get<std::string>();
    std::optional<nlohmann::ordered_json> found;
    for (const ShardFolder& shard : shards) {
      if (!shard.shard.has(i)) continue;
      const auto item = item_in(shard, name);
      if (!item) continue;
      if (found && *found != *item)
        throw Error(shard.path("items/" + name + ".json"),
                    fmt::format("differs from the one in '{}'", merged.folder_of_trace[i]),
                    "find out which is right (two traces may have the same name), and leave the other folder out");
      if (!found) merged.folder_of_trace[i] = shard.folder;
      found = item;
    }
    if (found) merged.items.push_back(*found);
  }
  add_failures(shards, merged);
  return merged;
}

}  // namespace vestige
