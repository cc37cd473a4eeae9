#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "detector/actuator_map.hpp"
#include "detector/actuators/actuator_layout.hpp"

namespace vestige {

/// A map as it was read, and where its actuators are on the body, if that was asked for.
struct WatchedMap {
  ActuatorMap map;
  std::shared_ptr<const ActuatorLayout> layout;
};

/// Reads an actuator map again when its PNG or its sidecar changes on disk, in a thread of its own, so that a map can
/// be edited while it is felt (HAVE 2010 §III.B). A file is read once it has been left alone for 0.1 s.
class ActuatorMapWatch {
 public:
  enum class Layouts { kNone, kMeasured };  ///< measuring takes its time

  /// What tells one state of a map's two files from another.
  static std::string stamp(const std::string& file);

  /// `file`: a PNG; `read_stamp`: its stamp from before it was read. Maps with another number of actuators than
  /// `actuator_count` are not taken, nor is what cannot be read: `warn` is told, in the watch's thread, and the old one
  /// stays. `avatar` stays in use.
  ActuatorMapWatch(std::string file, std::string read_stamp, std::size_t actuator_count, const Avatar& avatar,
                   Layouts layouts, std::function<void(const std::string&)> warn);
  /// Waits for the thread.
  ~ActuatorMapWatch();
  ActuatorMapWatch(const ActuatorMapWatch&) = delete;
  ActuatorMapWatch& operator=(const ActuatorMapWatch&) = delete;

  /// The newest map that has been read since the last call, whole.
  std::optional<WatchedMap> take();

 private:
  void run(const std::stop_token& stop);
  void read();

  std::string file_;
  std::size_t actuator_count_;
  const Avatar& avatar_;
  Layouts layouts_;
  std::function<void(const std::string&)> warn_;
  std::string read_stamp_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::optional<WatchedMap> map_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace vestige
