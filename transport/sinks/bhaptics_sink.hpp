#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/base/host_port.hpp"
#include "transport/actuator_sink.hpp"
#include "transport/sinks/bhaptics_places.hpp"
#include "transport/sinks/websocket_client.hpp"

namespace vestige {

/// The port on which bHaptics' Player listens.
inline constexpr std::uint16_t kBhapticsPort = 15881;

struct BhapticsOptions {
  HostPort place;
  /// How long the Player plays a frame, if no newer one comes.
  std::chrono::milliseconds duration{60};
};

/// Reads `bhaptics://HOST` or `bhaptics://HOST:PORT`, with or without a slash at the end. Throws `UsageError` with
/// --port.
HostPort parse_bhaptics_url(std::string_view url);

/// Sends frames to bHaptics' Player, a program on a PC, over a websocket: the protocol "v2/feedbacks", whose requests
/// are those of github.com/bhaptics/tact-js (src/HapticPlayer.ts) and tact-python (bhaptics/better_haptic_player.py).
///
/// Each frame is one JSON text with the intensities of all vibrators, including those that are off. The Player plays it
/// for `duration`, and replaces it if a newer one comes. So it switches everything off by itself if this program dies,
/// or if the network fails. What the Player sends, its status, is ignored.
class BhapticsSink final : public ActuatorSink {
 public:
  /// Connects, and waits for that at most 1 s. A Player that is not there is reported by `receive`, and may come later:
  /// `reconnect`. Throws `Error` as `bhaptics_places` does, and if the host is unknown.
  BhapticsSink(const BhapticsOptions& options, const std::vector<std::string>& actuator_names);

  std::string name() const override { return name_; }
  bool ready() override;
  /// Ignores levels beyond the actuators, and switches actuators beyond the levels off. Throws `LinkLost`.
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  int readable_descriptor() const override { return client_.descriptor(); }
  /// Returns nothing, because the Player answers no frame. Throws `LinkLost` if the connection is lost.
  std::vector<Acknowledgement> receive() override;
  bool reconnect() override;
  std::uint64_t bytes_sent() const override { return bytes_sent_; }
  /// Without the frames of the websocket.
  std::uint64_t texts_sent() const { return texts_sent_; }
  std::chrono::milliseconds duration() const { return duration_; }

 private:
  /// A device, or the side of a vest, that has actuators.
  struct Part {
    std::string_view position;
    std::vector<std::size_t> actuators;
  };
  std::string state_text(std::span<const std::uint8_t> level) const;
  std::string off_text() const;
  void send_text(const std::string& text);
  /// Throws `LinkLost` if the connection is not open.
  void require_open() const;

  std::string name_;
  std::chrono::milliseconds duration_;
  std::vector<BhapticsPlace> places_;  // of the actuators
  std::vector<Part> parts_;
  WebsocketClient client_;
  std::uint64_t bytes_sent_ = 0;
  std::uint64_t texts_sent_ = 0;
};

}  // namespace vestige
