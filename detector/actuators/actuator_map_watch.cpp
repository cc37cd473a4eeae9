#include "detector/actuators/actuator_map_watch.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks(100);

}  // namespace

ActuatorMapWatch::ActuatorMapWatch(std::string file, std::string read_stamp, std::size_t actuator_count,
                                   const Avatar& avatar, Layouts layouts, std::function<void(const std::string&)> warn)
    : file_(std::move(file)),
      actuator_count_(actuator_count),
      avatar_(avatar),
      layouts_(layouts),
      warn_(std::move(warn)),
      read_stamp_(std::move(read_stamp)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

ActuatorMapWatch::~ActuatorMapWatch() = default;

std::optional<WatchedMap> ActuatorMapWatch::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(map_, std::nullopt);
}

std::string ActuatorMapWatch::stamp(const std::string& file) {
  std::string text;
  for (const std::string& name : {file, sidecar_path(file).string()}) {
    struct stat status = {};
    if (::stat(name.c_str(), &status) == 0)
      text +=
          fmt::format("{}.{:09} {} {};", status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_ino);
    else
      text += "none;";
  }
  return text;
}

void ActuatorMapWatch::run(const std::stop_token& stop) {
  std::string seen = read_stamp_;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    stopped_.wait_for(lock, stop, kBetweenLooks, [] { return false; });
    lock.unlock();
    const std::string now = stamp(file_);
    if (now == seen && now != read_stamp_) {
      read_stamp_ = now;
      read();
    }
    seen = now;
    lock.lock();
  }
}

void ActuatorMapWatch::read() try {
  // Reading a pipe might never end.
  for (const auto& file : {std::filesystem::path(file_), sidecar_path(file_)})
    if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))
      throw Error(file.string(), "is no longer a regular file", "write a regular file under this name");
  ActuatorMap map = parse_actuator_map(read_actuator_map_files(file_), avatar_, file_);
  if (map.actuator_count != actuator_count_)
    throw Error(file_, fmt::format("now has {} actuators, but {} are in use", map.actuator_count, actuator_count_),
                "start the command again to use this map");
  std::shared_ptr<const ActuatorLayout> layout;
  if (layouts_ == Layouts::kMeasured) layout = std::make_shared<ActuatorLayout>(avatar_, map);
  const std::lock_guard lock(mutex_);
  map_ = {std::move(map), std::move(layout)};
} catch (const std::exception& error) {
  warn_(fmt::format("{}\n  The previous map stays in use.", error.what()));
}

}  // namespace vestige
