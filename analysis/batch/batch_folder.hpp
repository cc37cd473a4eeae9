#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// kReplace: a folder of another batch becomes one of this; what it has of use to this one is kept.
enum class OtherBatch { kRefuse, kReplace };

/// What one process at a time holds while it writes into a folder. Let go when the process ends, however it ends.
class FolderLock {
 public:
  /// Makes the folder unless it exists. Throws `Error` when another process has it, naming process and machine.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// A batch's folder:
///   run.json                where it comes from, its inputs, what failed, what took how long
///   scores.csv|json         map, trace, law, then each metric
///   ranking.csv|json        a row for each map and law
///   items/NAME.json         a trace's scores; times/NAME.json: where and when, and what it took
///   contacts/NAME.csv       a trace's contacts
///   traces/NAME.mcap        a scenario, recorded
///   maps/NAME.png|json, avatar.glb, actuator.json
/// Each file is complete or absent. An item's file is written last, so that one that is there has all of its files.
class BatchFolder {
 public:
  /// Locks the folder, refuses one of another batch or with files that are none of a batch's, and removes what a killed
  /// run of this batch left half-written. `batch`: `to_json(plan)`. Throws `Error`.
  BatchFolder(std::filesystem::path folder, const nlohmann::ordered_json& batch, const Shard& shard, OtherBatch other);

  std::string item(const std::string& name) const { return file("items", name, ".json"); }
  std::string item_times(const std::string& name) const { return file("times", name, ".json"); }
  std::string contacts(const std::string& name) const { return file("contacts", name, ".csv"); }
  std::string trace(const std::string& name) const { return file("traces", name, ".mcap"); }
  /// Where a scenario's trace grows until it is complete.
  std::string growing_trace(const std::string& name) const { return file("traces", "." + name, ".mcap"); }
  std::string map_png(const std::string& name) const { return file("maps", name, ".png"); }
  std::string map_json(const std::string& name) const { return file("maps", name, ".json"); }
  std::string top(std::string_view name) const { return (folder_ / name).string(); }

  /// Removes scores and ranking, and a page about them unless `run`, a run.json that is to be written, has the traces
  /// and results of the finished one that is there. Without "traces" in it, only its command is looked at.
  void remove_results(const nlohmann::ordered_json& run) const;

  /// The item of that trace, if it is there with its contacts and is a result of this key and trace.
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
  nlohmann::ordered_json earlier_run_;  ///< run.json as it was found; null: there was none
};

/// Writes a file that is complete or absent, in the place of an older one.
void write_file(const std::string& path, std::string_view text);

/// The same, but where `text` is empty, for there is none, one that an earlier batch left goes. Throws `Error`.
void write_or_remove_file(const std::string& path, std::string_view text);

/// `write_file`, with an indent of 2.
void write_json_file(const std::string& path, const nlohmann::ordered_json& json);

/// Reads a JSON object. Throws `Error` naming the file.
nlohmann::ordered_json read_json_object(const std::string& path, std::string_view remedy);

}  // namespace vestige
