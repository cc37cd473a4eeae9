#include "analysis/batch/batch_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "traces/input_file.hpp"
#include "traces/output_file.hpp"

namespace vestige {

namespace {

constexpr const char* kFolders[] = {"items", "contacts", "traces", "maps"};
constexpr const char* kLockName = ".lock";
constexpr const char* kShards = "shards";  // of a Slurm run that is merged into this folder, with their logs
constexpr const char* kLogs = "logs";
constexpr std::string_view kOtherFolder = "choose another -o, or add --force to replace it";

std::string this_process() {
  utsname machine = {};
  ::uname(&machine);
  return fmt::format("process {} on {}", ::getpid(), machine.nodename);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder.string(), "the folder cannot be made: " + failure.message(), "choose another -o");
}

bool same_command(const nlohmann::ordered_json& run, const nlohmann::ordered_json& batch, const Shard& shard) {
  try {
    return command_of(run.at("batch")) == command_of(batch) && run.at("shard").at("number") == shard.number &&
           run.at("shard").at("count") == shard.count;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
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
                "wait for its end, or choose another -o");
  }
  const std::string holder = this_process();
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, holder.data(), holder.size(), 0) < 0) {
    // Who holds the lock is a courtesy: a full disk is said by whoever writes results.
  }
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

BatchFolder::BatchFolder(std::filesystem::path folder, const nlohmann::ordered_json& batch, const Shard& shard,
                         OtherBatch other)
    : folder_(std::move(folder)), lock_(folder_) {
  refuse_others(batch, shard, other);
  for (const char* name : kFolders) make_folder(folder_ / name);
  remove_leftovers();
}

void BatchFolder::refuse_others(const nlohmann::ordered_json& batch, const Shard& shard, OtherBatch other) const {
  if (other == OtherBatch::kReplace) return;
  const auto run = folder_ / "run.json";
  if (!std::filesystem::exists(run)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().filename() != kLockName && entry.path().filename() != kShards &&
          entry.path().filename() != kLogs)
        throw Error(folder_.string(),
                    fmt::format("there is no batch in it, but '{}'", entry.path().filename().string()), kOtherFolder);
    return;
  }
  if (!same_command(read_json_object(run.string(), kOtherFolder), batch, shard))
    throw Error(folder_.string(), "holds another batch: other maps, traces, laws, options or shard (run.json)",
                kOtherFolder);
}

void BatchFolder::remove_leftovers() const {
  std::error_code ignored;
  std::vector<std::filesystem::path> folders = {folder_};
  for (const char* name : kFolders) folders.push_back(folder_ / name);
  for (const auto& folder : folders)
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().filename().string().starts_with('.') && entry.path().filename() != kLockName)
        std::filesystem::remove(entry.path(), ignored);
}

std::optional<nlohmann::ordered_json> BatchFolder::finished(const std::string& name, const std::string& key,
                                                            const std::string& trace_sha256) const {
  const std::string path = item(name);
  if (!std::filesystem::exists(path)) return std::nullopt;
  auto json = nlohmann::ordered_json::parse(read_text_file(path), nullptr, false);
  const auto says = [&](const char* field, const std::string& value) {
    return json.is_object() && json.contains(field) && json[field] == value;
  };
  if (!says("key", key) || !says("trace_sha256", trace_sha256)) return std::nullopt;
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

void write_json_file(const std::string& path, const nlohmann::ordered_json& json) {
  write_file(path, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

nlohmann::ordered_json read_json_object(const std::string& path, std::string_view remedy) {
  auto json = nlohmann::ordered_json::parse(read_text_file(path), nullptr, false);
  if (!json.is_object()) throw Error(path, "is no JSON object", remedy);
  return json;
}

}  // namespace vestige
