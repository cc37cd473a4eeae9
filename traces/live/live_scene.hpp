#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "traces/live/live_state.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Joins what several sources send, one for each person, to frames of one scene. An id of a collider belongs to the
/// source that sent it first, as long as its frames have it; colliders and teleports of others with this id are left
/// out.
class LiveScene {
 public:
  /// The sources must outlive the scene.
  explicit LiveScene(std::vector<LiveState*> sources) : sources_(std::move(sources)) {}

  /// Returns in `frame` the newest whole frame of every source, without number and time. Returns which ids each source
  /// has teleported, for `LiveState::mark_teleported`.
  std::vector<std::vector<std::uint32_t>> show(TraceFrame& frame);
  /// Whether several sources sent colliders of one id.
  bool ids_clash() const { return ids_clash_; }

 private:
  /// Finds out of `shown_` whose each collider is.
  void find_owners();

  std::vector<LiveState*> sources_;
  std::unordered_map<std::uint32_t, std::size_t> source_of_;  ///< of each collider's id: who sent it first
  std::vector<TraceFrame> shown_;                             ///< of each source
  bool ids_clash_ = false;
};

}  // namespace vestige
