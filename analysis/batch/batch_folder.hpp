#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// kReplace: a folder of another batch becomes a folder of this batch. Files that this batch can use are kept.
enum class OtherBatch { kRefuse, kReplace };

/// The lock that one process at a time holds while it writes into a folder. The lock is released when the process ends,
/// however it ends.
class FolderLock {
 public:
  /// Makes the folder if it does not exist. Throws `Error` with process and machine if another process has the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// A batch's folder:
///   run.json                origin, inputs, failures and durations
///   scores.csv|json         map, trace, law, then each metric
///   ranking.csv|json        a row for each map and law
///   ranking_by_scenario.csv a row for each scenario, map and law; with several scenarios
///   items/NAME.json         a trace's scores
///   times/NAME.json         where and when the scores were computed, and how long it took
///   contacts/NAME.csv       a trace's contacts
///   traces/NAME.mcap        a scenario, recorded
///   maps/NAME.png|json, avatar.glb, actuator.json
/// Each file is either complete or absent. An item's file is written last: if it exists, all files of the item exist.
class BatchFolder {
 public:
  /// Locks the folder. Removes files that a killed run of this batch left half-written. `batch` is `to_json(plan)`.
  /// Throws `Error` if the folder holds another batch, or files without a batch, and `other` is kRefuse; also if it
  /// holds results of another verb.
  BatchFolder(std::filesystem::path folder, const nlohmann::ordered_json& batch, const Shard& shard, OtherBatch other);

  std::string item(const std::string& name) const { return file("items", name, ".json"); }
  std::string item_times(const std::string& name) const { return file("times", name, ".json"); }
  std::string contacts(const std::string& name) const { return file("contacts", name, ".csv"); }
  std::string trace(const std::string& name) const { return file("traces", name, ".mcap"); }
  /// Returns the path of a scenario's trace until it is complete.
  std::string growing_trace(const std::string& name) const { return file("traces", "." + name, ".mcap"); }
  std::string map_png(const std::string& name) const { return file("maps", name, ".png"); }
  std::string map_json(const std::string& name) const { return file("maps", name, ".json"); }
  std::string top(std::string_view name) const { return (folder_ / name).string(); }

  /// Removes scores and ranking. Also removes the page about them, unless the finished run in the folder has the same
  /// traces and results as `run`, a run.json that is to be written. If `run` has no "traces", only its command is
  /// compared.
  void remove_results(const nlohmann::ordered_json& run) const;

  /// Returns the item of a trace if the item and its contacts exist and belong to this key and this trace. Otherwise
  /// returns nothing.
  std::optional<nlohmann::ordered_json> finished(const std::string& name, const std::string& key,
                                                 const std::string& trace_sha256) const;

 private:
  std::string file(std::string_view folder, std::string_view name, std::string_view extension) const;
  void refuse_others(const nlohmann::ordered_json& batch, const Shard& shard, OtherBatch other) const;
  void remove_leftovers(const nlohmann::ordered_json& batch) const;
  void remove_replaced(const nlohmann::ordered_json& batch) const;
  void remove_page() const;

  std::filesystem::path folder_;
  FolderLock lock_;
  nlohmann::ordered_json earlier_run_;  ///< run.json as it was found; null if there was none
};

/// Writes a file that is either complete or absent. Replaces an older file.
void write_file(const std::string& path, std::string_view text);

/// As `write_file`, but if `text` is empty, removes the file that an earlier batch left. Throws `Error`.
void write_or_remove_file(const std::string& path, std::string_view text);

/// As `write_file`, for JSON with an indent of 2.
void write_json_file(const std::string& path, const nlohmann::ordered_json& json);

/// Reads a JSON object. Throws `Error` with the file's name.
nlohmann::ordered_json read_json_object(const std::string& path, std::string_view remedy);

}  // namespace vestige
