#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transport/actuator_sink.hpp"
#include "transport/sinks/osc_address.hpp"

namespace vestige {

/// Sends frames as OSC 1.0 over UDP: a parameter for each actuator.
///
/// Every frame is one bundle (more where it would not fit into a network packet) with all values, also those that did
/// not change: a datagram may be lost, and a receiver may start late; so each frame stands for itself, and the next one
/// mends what a lost one left. That nobody listens is no error: see `is_refused`. OSC has no time to live: what a
/// receiver does when frames cease is its own business.
class OscSink final : public ActuatorSink {
 public:
  /// A name may be resolved here; IPv4 is preferred, as OSC programs listen there. Throws `UsageError` as
  /// `osc_addresses` does, and `Error` for a host that is not known.
  OscSink(OscOptions options, const std::vector<std::string>& actuator_names);
  ~OscSink() override;

  std::string name() const override { return osc_url(options_); }
  /// Levels beyond the actuators are ignored; actuators beyond the levels are off. `LinkLost`: there is no way to the
  /// host for now.
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  bool reconnect() override;
  /// Sends an empty bundle and waits a moment (50 ms) for the host's word that nobody listens at this port. Most hosts
  /// give it; a firewall may keep it back.
  bool is_refused() const;
  std::uint64_t bytes_sent() const override { return bytes_sent_; }

 private:
  /// On which errors of the host come back; negative, with errno, where there is no way to it.
  int connected_socket() const;
  void send_levels(std::span<const std::uint8_t> level);
  void send_datagram(std::span<const std::byte> bytes);

  OscOptions options_;
  std::vector<std::string> addresses_;  // of the actuators
  sockaddr_storage host_ = {};
  socklen_t host_bytes_ = 0;
  int socket_ = -1;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace vestige
