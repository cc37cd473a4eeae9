#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "transport/actuator_sink.hpp"
#include "transport/sender.hpp"
#include "transport/wire/vest_frame.hpp"

namespace vestige {
class BhapticsSink;
class OscSink;
class SerialSink;
class WireFileSink;
}  // namespace vestige

namespace vestige::cli {

/// The flags for the destination of frames. They mean the same in every verb that drives a vest.
struct SinkChoice {
  std::string port;
  std::uint32_t baud = 0;
  int ttl_ms = 200;
  std::string levels = "duty";
  bool xbee_api = false;
  std::string xbee_request = "transmit";
  std::string xbee_address = "FFFF";
  bool xbee_escaped = false;
  std::string osc_address;
  std::string osc_value = "float";

  Quantity quantity() const { return levels == "pressure" ? Quantity::kPressure : Quantity::kDuty; }
  bool is_osc() const { return port.starts_with(kOscPrefix); }
  /// Whether the port is bHaptics' Player.
  bool is_bhaptics() const { return port.starts_with(kBhapticsPrefix); }
  bool is_serial() const { return !is_osc() && !is_bhaptics() && !is_file() && !is_vmc(); }
  /// Whether the port takes poses and colliders, not actuator frames: only `stream` sends them.
  bool is_vmc() const { return port.starts_with(kVmcPrefix); }
  bool is_file() const { return port == "-" || port.starts_with(kFilePrefix); }
  /// The same settings for another port.
  SinkChoice at(std::string other_port) const;
  /// Returns the path of the file that receives frames, "-" for standard output, or empty.
  std::string output_path() const;

  static constexpr std::string_view kOscPrefix = "osc:";
  static constexpr std::string_view kBhapticsPrefix = "bhaptics:";
  static constexpr std::string_view kFilePrefix = "file:";
  static constexpr std::string_view kVmcPrefix = "vmc:";
  static constexpr std::string_view kVmcScheme = "vmc";
};

/// Adds --port, --baud, --ttl, --levels, --xbee-api, --xbee-request, --xbee-address, --xbee-escaped, --osc-address and
/// --osc-value.
void add_sink_options(CLI::App& verb, SinkChoice& choice);
/// Whether ports may also be of programs that take poses and colliders.
enum class VmcPorts : std::uint8_t { kTaken, kRefused };
/// The same for several sinks, which differ in their port: --port may say whose it is. `levels_remark` follows the help
/// of --levels.
void add_sinks_options(CLI::App& verb, SinkChoice& settings, std::vector<std::string>& ports,
                       const std::string& levels_remark, VmcPorts vmc_ports);

/// The actuators that a frame addresses, if a board reports how many it has.
enum class Driven { kThoseNamed, kAllOfTheBoard };

/// An open sink, and what is known of the other end.
class OpenSink {
 public:
  /// Opens the sink. On a serial line, asks the board to identify itself, and warns on standard error if there is a
  /// problem.
  OpenSink(const SinkChoice& choice, const std::vector<std::string>& actuator_names, const CommonOptions& options,
           Driven driven = Driven::kThoseNamed);
  ~OpenSink();
  OpenSink(const OpenSink&) = delete;
  OpenSink& operator=(const OpenSink&) = delete;

  ActuatorSink& sink() const { return *sink_; }
  /// The board's answer; empty if no board answered, or if none was asked.
  const std::optional<Greeting>& greeting() const { return greeting_; }
  /// Warns if the board drives fewer actuators than `actuators`.
  void warn_of_actuators_beyond(std::size_t actuators, Verbosity verbosity) const;
  /// Returns the least time between two frames: 5 ms, or longer if the line or the board's chips take longer for one.
  std::chrono::microseconds floor() const;
  /// Returns after how long an unchanged state is sent again: 20 ms, or less to be within a third of --ttl.
  std::chrono::microseconds refresh() const;
  /// Finishes the output file, if there is one.
  void commit();

  /// Returns what an XBee in API mode reports about packets that it could not deliver; empty if all were delivered.
  std::string radio_failure() const;
  nlohmann::ordered_json link_json() const;
  /// Describes the link for people in a line or two. `bytes` is the number of bytes sent.
  std::string describe_link(std::uint64_t bytes) const;

 private:
  /// Returns a frame's time on the line, at 10 bits a byte.
  double line_time_s() const;
  void open_bhaptics(const std::vector<std::string>& actuator_names);

  SinkChoice choice_;
  std::unique_ptr<ActuatorSink> sink_;
  OscSink* osc_ = nullptr;
  BhapticsSink* bhaptics_ = nullptr;
  WireFileSink* file_ = nullptr;
  SerialSink* serial_ = nullptr;
  std::optional<Greeting> greeting_;
  std::size_t outputs_ = 0;      ///< of the board; if it does not answer, those that frames name
  std::size_t frame_bytes_ = 0;  ///< size of a state frame on the line
};

/// Returns what is not confirmed about the switching off at the end; empty if nothing is in doubt. Of a sink that never
/// answers, only frames that could not be sent are in doubt.
std::string doubt_about_off(const SenderStatistics& statistics, const ActuatorSink& sink);

}  // namespace vestige::cli
