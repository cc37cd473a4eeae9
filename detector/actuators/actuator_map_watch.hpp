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

/// A map as it was read, and its layout on the body, if requested.
struct WatchedMap {
  ActuatorMap map;
  std::shared_ptr<const ActuatorLayout> layout;
};

/// Reads an actuator map again, in its own thread, when its PNG or its sidecar changes on disk. So a user can edit a
/// map and feel the result at once (HAVE 2010 §III.B). The watch reads a file once the file has not changed for 0.1 s.
class ActuatorMapWatch {
 public:
  enum class Layouts { kNone, kMeasured };  ///< measuring a layout takes time

  /// Returns a text that differs between two states of a map's two files.
  static std::string stamp(const std::string& file);

  /// `file` is a PNG, and `read_stamp` is the stamp that it had before it was read. The watch rejects a map that it
  /// cannot read, or whose number of actuators is not `actuator_count`. Then it calls `warn`, in the watch's thread,
  /// and the old map stays. The watch keeps a reference to `avatar`.
  ActuatorMapWatch(std::string file, std::string read_stamp, std::size_t actuator_count, const Avatar& avatar,
                   Layouts layouts, std::function<void(const std::string&)> warn);
  /// Waits for the thread to end.
  ~ActuatorMapWatch();
  ActuatorMapWatch(const ActuatorMapWatch&) = delete;
  ActuatorMapWatch& operator=(const ActuatorMapWatch&) = delete;

  /// Returns the newest map that was completely read since the last call.
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
