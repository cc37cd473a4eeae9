#include "analysis/batch/batch_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "analysis/base/results_folder.hpp"
#include "analysis/batch/batch_plan.hpp"
#include "traces/base/system_error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

namespace {

constexpr const char* kFolders[] = {"items", "times", "contacts", "traces", "maps"};
constexpr const char* kLockName = ".lock";
constexpr const char* kPage = "report.html";
constexpr const char* kFigures = "figures";  // figures of the page
constexpr const char* kResults[] = {"scores.csv", "scores.json", "ranking.csv", "ranking.json",
                                    "ranking_by_scenario.csv"};
constexpr const char* kShards = "shards";  // shards of a Slurm run that is merged into this folder
constexpr const char* kLogs = "logs";
constexpr std::string_view kOtherFolder = "choose another -o, or add --force to replace it";

std::string this_process() {
  utsname machine = {};
  ::uname(&machine);
  return fmt::format("process {} on {}", ::getpid(), machine.nodename);
}

bool same_command(const nlohmann::ordered_json& run, const nlohmann::ordered_json& batch, const Shard& shard) {
  try {
    return command_of(run.at("batch")) == command_of(batch) && run.at("shard").at("number") == shard.number &&
           run.at("shard").at("count") == shard.count;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

/// Returns whether a file has the name .NAME.XXXXXX, which `OutputFile` gives to one of `written` until it is complete.
bool is_half_written(const std::string& file, const std::set<std::string>& written) {
  constexpr std::size_t kEnd = 7;
  if (file.size() < kEnd + 2 || file.front() != '.' || file[file.size() - kEnd] != '.') return false;
  const auto is_random = [](char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0; };
  return std::all_of(file.end() - kEnd + 1, file.end(), is_random) &&
         written.contains(file.substr(1, file.size() - kEnd - 1));
}

/// Adds the names of `list`, a list under "batch" in run.json, each followed by `extension`.
void add_names(std::set<std::string>& names, const nlohmann::ordered_json& list, std::string_view extension) {
  for (const nlohmann::ordered_json& one : list)
    names.insert(fmt::format("{}{}", one.at("name").get<std::string>(), extension));
}

/// Returns the name and SHA-256 of each trace that a run.json has a result of.
std::vector<std::string> traces_of_run(const nlohmann::ordered_json& run) {
  std::vector<std::string> traces;
  for (const nlohmann::ordered_json& trace : run.at("traces"))
    traces.push_back(fmt::format("{} {}", trace.at("name").get<std::string>(), trace.at("sha256").get<std::string>()));
  return traces;
}

/// Returns whether a finished run has the results that `run` will have, as far as `run` tells.
bool has_results_of(const nlohmann::ordered_json& finished, const nlohmann::ordered_json& run) {
  try {
    if (!finished.at("complete").get<bool>()) return false;
    for (const char* field : {"batch", "shard", "rank_by"})
      if (finished.at(field) != run.at(field)) return false;
    return !run.contains("traces") ||
           (finished.at("failures") == run.at("failures") && traces_of_run(finished) == traces_of_run(run));
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

/// Returns `folder`. Throws `Error` before anything is written there if another verb's results would be lost.
std::filesystem::path without_other_results(std::filesystem::path folder) {
  refuse_other_results(folder, "batch");
  return folder;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  make_folder(folder);
  const auto path = folder / kLockName;
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw system_error(path, "could not open for writing", errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int failure = errno;
    char holder[256] = {};
    const ssize_t length = ::pread(descriptor_, holder, sizeof holder - 1, 0);
    ::close(std::exchange(descriptor_, -1));
    if (failure != EWOULDBLOCK) throw system_error(path, "could not lock", failure);
    throw Error(folder.string(),
                fmt::format("another batch is writing into this folder{}{}", length > 0 ? ", " : "", holder),
                "wait until that batch ends, or choose another -o");
  }
  const std::string holder = this_process();
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, holder.data(), holder.size(), 0) < 0) {
    // The holder's name is only a courtesy. A full disk is reported by the code that writes results.
  }
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

BatchFolder::BatchFolder(std::filesystem::path folder, const nlohmann::ordered_json& batch, const Shard& shard,
                         OtherBatch other)
    : folder_(without_other_results(std::move(folder))), lock_(folder_) {
  refuse_others(batch, shard, other);
  const auto run = folder_ / "run.json";
  if (std::filesystem::exists(run))
    earlier_run_ = nlohmann::ordered_json::parse(read_text_file(run.string()), nullptr, false);
  for (const char* name : kFolders) make_folder(folder_ / name);
  remove_leftovers(batch);
  remove_replaced(batch);
}

void BatchFolder::refuse_others(const nlohmann::ordered_json& batch, const Shard& shard, OtherBatch other) const {
  if (other == OtherBatch::kReplace) return;
  const auto run = folder_ / "run.json";
  if (!std::filesystem::exists(run)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().filename() != kLockName && entry.path().filename() != kShards &&
          entry.path().filename() != kLogs)
        throw Error(folder_.string(), fmt::format("contains '{}', but no batch", entry.path().filename().string()),
                    kOtherFolder);
    return;
  }
  if (!same_command(read_json_object(run.string(), kOtherFolder), batch, shard))
    throw Error(folder_.string(),
                "holds another batch: the maps, traces, laws, options or shard in its run.json differ", kOtherFolder);
}

void BatchFolder::remove_leftovers(const nlohmann::ordered_json& batch) const {
  const auto remove = [&](const std::filesystem::path& folder, const std::set<std::string>& written,
                          const std::set<std::string>& growing) {
    std::vector<std::filesystem::path> leftovers;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (std::filesystem::is_regular_file(entry.symlink_status()) &&
          (is_half_written(name, written) || growing.contains(name)))
        leftovers.push_back(entry.path());
    }
    std::error_code ignored;
    for (const auto& path : leftovers) std::filesystem::remove(path, ignored);
  };
  // Without a run.json, these files may not come from a batch.
  if (!earlier_run_.is_null()) {
    std::set<std::string> top = {"run.json", "avatar.glb", "actuator.json"};
    top.insert(std::begin(kResults), std::end(kResults));
    remove(folder_, top, {});
  }
  const nlohmann::ordered_json& traces = batch.at("traces");
  std::set<std::string> items;
  std::set<std::string> contacts;
  std::set<std::string> growing;
  std::set<std::string> recorded;
  std::set<std::string> maps;
  add_names(items, traces, ".json");
  add_names(contacts, traces, ".csv");
  add_names(recorded, traces, ".mcap");
  for (const std::string& name : recorded) {
    growing.insert("." + name);
    growing.insert("." + name + ".partial");  // left by a full disk
  }
  recorded.insert(growing.begin(), growing.end());
  add_names(maps, batch.at("maps"), ".png");
  add_names(maps, batch.at("maps"), ".json");
  remove(folder_ / "items", items, {});
  remove(folder_ / "times", items, {});
  remove(folder_ / "contacts", contacts, {});
  remove(folder_ / "traces", recorded, growing);
  remove(folder_ / "maps", maps, {});
}

/// Removes what an earlier batch, which this batch replaces, wrote for maps and traces that this batch does not have.
void BatchFolder::remove_replaced(const nlohmann::ordered_json& batch) const {
  const auto names_in = [](const nlohmann::ordered_json& of, const char* list) {
    std::set<std::string> found;
    add_names(found, of.at(list), "");
    // Not from a batch.
    std::erase_if(found, [](const std::string& name) { return name.find('/') != std::string::npos; });
    return found;
  };
  std::vector<std::string> replaced;
  try {
    const std::set<std::string> traces = names_in(batch, "traces");
    for (const std::string& name : names_in(earlier_run_.at("batch"), "traces"))
      if (!traces.contains(name))
        replaced.insert(replaced.end(), {item(name), item_times(name), contacts(name), trace(name)});
    const std::set<std::string> maps = names_in(batch, "maps");
    for (const std::string& name : names_in(earlier_run_.at("batch"), "maps"))
      if (!maps.contains(name)) replaced.insert(replaced.end(), {map_png(name), map_json(name)});
  } catch (const nlohmann::json::exception&) {
    return;  // there was no batch, or its run.json is not valid
  }
  std::error_code ignored;
  for (const std::string& path : replaced) std::filesystem::remove(path, ignored);
}

void BatchFolder::remove_page() const {
  std::error_code ignored;
  if (!std::filesystem::remove(folder_ / kPage, ignored)) return;
  std::vector<std::filesystem::path> figures;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / kFigures, ignored))
    if (const auto extension = entry.path().extension();
        extension == ".svg" || extension == ".png" || extension == ".html")
      figures.push_back(entry.path());
  for (const auto& path : figures) std::filesystem::remove(path, ignored);
  std::filesystem::remove(folder_ / kFigures, ignored);  // fails if the folder has other files
}

void BatchFolder::remove_results(const nlohmann::ordered_json& run) const {
  std::error_code ignored;
  for (const char* name : kResults) std::filesystem::remove(folder_ / name, ignored);
  if (!has_results_of(earlier_run_, run)) remove_page();
}

std::optional<nlohmann::ordered_json> BatchFolder::finished(const std::string& name, const std::string& key,
                                                            const std::string& trace_sha256) const {
  const std::string path = item(name);
  if (!std::filesystem::exists(path) || !std::filesystem::exists(contacts(name))) return std::nullopt;
  auto json = nlohmann::ordered_json::parse(read_text_file(path), nullptr, false);
  const auto says = [&](const char* field, const std::string& value) {
    return json.is_object() && json.contains(field) && json[field] == value;
  };
  if (!says("key", key) || !says("trace_sha256", trace_sha256)) return std::nullopt;
  if (!says("contacts_sha256", sha256_of_file(contacts(name)))) return std::nullopt;
  return json;
}

std::string BatchFolder::file(std::string_view folder, std::string_view name, std::string_view extension) const {
  return (folder_ / folder / fmt::format("{}{}", name, extension)).string();
}

void write_file(const std::string& path, std::string_view text) {
  OutputFile file(path, Overwrite::kAllow);
  file.write(text);
  file.commit();
}

void write_or_remove_file(const std::string& path, std::string_view text) {
  if (!text.empty()) return write_file(path, text);
  std::error_code failure;
  std::filesystem::remove(path, failure);
  if (failure)
    throw Error(path, fmt::format("is from an earlier batch and cannot be removed: {}", failure.message()),
                "remove it, or choose another -o");
}

void write_json_file(const std::string& path, const nlohmann::ordered_json& json) {
  write_file(path, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

nlohmann::ordered_json read_json_object(const std::string& path, std::string_view remedy) {
  auto json = nlohmann::ordered_json::parse(read_text_file(path), nullptr, false);
  if (!json.is_object()) throw Error(path, "is not a JSON object", remedy);
  return json;
}

}  // namespace vestige
