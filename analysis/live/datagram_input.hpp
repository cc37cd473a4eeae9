#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/live/live_input.hpp"
#include "analysis/live/pose_ramp.hpp"
#include "traces/base/host_port.hpp"
#include "traces/live/live_scene.hpp"
#include "traces/live/live_state.hpp"
#include "traces/live/udp_receiver.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// How poses are shown that come slower than colliders. kInterpolate: one pose late, so that the body never jumps.
/// kLatest: the newest pose at once.
enum class PoseShown : std::uint8_t { kInterpolate, kLatest };

/// Where the datagrams of a person come to.
struct LivePort {
  std::string name;  ///< "vmc://0.0.0.0:39539", for messages
  HostPort place;
  const Avatar& avatar;
};

/// Input by the VMC protocol, a port for each person.
///
/// With `PoseShown::kInterpolate`, poses are led to by a `PoseRamp`, each for as long as it took to come after the pose
/// before, from the first time on that a frame was shown between two poses. A pose that comes more than 0.2 s after the
/// one before, or whose root is more than 1 m away from it, is shown at once, and no motion leads to it.
///
/// If nothing whole has come to a port for the time to live, and something to another one, that person is silent, and
/// the colliders that came to the port are gone. So are those of a program that sends only colliders and has been
/// silent for so long.
class DatagramInput final : public LiveInput {
 public:
  /// Throws `Error` if a port cannot be opened, or an avatar cannot be moved by VMC. Keeps references to the avatars.
  DatagramInput(std::span<const LivePort> ports, PoseShown poses, std::chrono::milliseconds ttl);

  std::vector<int> descriptors() const override;
  void receive() override;
  std::uint64_t frames() const override;
  bool has_begun() const override;
  bool has_ended() const override { return false; }
  Clock::time_point arrived() const override;
  void show(Clock::time_point time, LiveFrame& out) override;
  std::uint64_t superseded() const override { return superseded_; }
  std::vector<RecordingNote> take_markers() override;
  std::vector<std::string> take_problems() override;
  LiveLosses losses() const override;

 private:
  struct Source {
    Source(const LivePort& port, LiveState::Senders senders);

    std::string name;
    const Avatar& avatar;
    UdpReceiver datagrams;
    LiveState state;
    PoseRamp ramp;
    std::uint64_t frames_shown = 0;
    std::uint64_t poses_shown = 0;
    bool came_between = false;  ///< a frame was shown since the newest pose was
    bool is_led = false;        ///< poses are led to
    bool is_silent = false;
    Clock::time_point pose_arrived;  ///< of the newest pose that was shown
    glm::dvec3 root_m = glm::dvec3(0);
    std::size_t problems_told = 0;
    bool stranger_told = false;
  };

  static std::deque<Source> sources_of(std::span<const LivePort> ports);
  static std::vector<LiveState*> states_of(std::deque<Source>& sources);
  void look_for_missing();
  void count_superseded();
  void look_for_silence(Source& source, Clock::time_point time);
  void lead(Source& source, Pose& pose, Clock::time_point time, LiveFrame& out) const;

  PoseShown poses_;
  std::chrono::milliseconds ttl_;
  std::deque<Source> sources_;
  LiveScene scene_;
  std::uint64_t superseded_ = 0;
  bool has_shown_ = false;
  std::optional<Clock::time_point> others_wait_since_;  ///< for people who have sent nothing yet
  bool missing_told_ = false;
  bool clash_told_ = false;
  std::vector<std::string> problems_;  ///< not told yet
};

}  // namespace vestige
