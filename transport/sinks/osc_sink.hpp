#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transport/actuator_sink.hpp"
#include "transport/sinks/datagram_sender.hpp"
#include "transport/sinks/off_watchdog.hpp"
#include "transport/sinks/osc_address.hpp"

namespace vestige {

/// Sends frames as OSC 1.0 over UDP: one parameter for each actuator.
///
/// Every frame is one bundle (more if it does not fit into a network packet) with all values, including unchanged ones.
/// A datagram may be lost, and a receiver may start late. So each frame is complete, and the next one corrects the loss
/// of one before. A missing receiver is not an error: see `is_refused`. OSC has no time to live, so a receiver keeps
/// what it heard last: a child process switches everything off where this program cannot (`OffWatchdog`).
class OscSink final : public ActuatorSink {
 public:
  /// Resolves a host name. IPv4 is preferred, because OSC programs listen there. Throws `UsageError` as `osc_addresses`
  /// does, and `Error` if the host is unknown.
  OscSink(OscOptions options, const std::vector<std::string>& actuator_names);

  std::string name() const override { return out_.name(); }
  /// Ignores levels beyond the actuators, and switches actuators beyond the levels off. Throws `LinkLost` if there is
  /// no route to the host for now.
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  bool reconnect() override { return out_.has_route(); }
  /// Switches everything off, and says whether the host reports that no program listens: `DatagramSender::is_refused`.
  bool is_refused() { return out_.is_refused(datagrams_of({})); }
  std::uint64_t bytes_sent() const override { return out_.bytes_sent(); }
  /// What a receiver gets if none is lost: states, and the datagrams that switch everything off first and last.
  std::uint64_t datagrams_sent() const { return out_.datagrams_sent(); }

 private:
  void send_levels(std::span<const std::uint8_t> level);
  std::vector<std::vector<std::byte>> datagrams_of(std::span<const std::uint8_t> level) const;

  OscOptions options_;
  std::vector<std::string> addresses_;  // addresses of the actuators
  DatagramSender out_;
  OffWatchdog watchdog_;
};

}  // namespace vestige
