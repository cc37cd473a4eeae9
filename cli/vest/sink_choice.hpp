#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "transport/actuator_sink.hpp"
#include "transport/wire/vest_frame.hpp"

namespace vestige {
class FrameFileSink;
class SerialSink;
}  // namespace vestige

namespace vestige::cli {

/// The flags that say where frames go: they mean the same in every verb that drives a vest.
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
  bool is_file() const { return port == "-" || port.starts_with(kFilePrefix); }
  /// The file that frames go to, "-", or empty.
  std::string output_path() const;

  static constexpr std::string_view kOscPrefix = "osc:";
  static constexpr std::string_view kFilePrefix = "file:";
};

/// Adds --port, --baud, --ttl, --levels, --xbee-api, --xbee-request, --xbee-address, --xbee-escaped, --osc-address and
/// --osc-value.
void add_sink_options(CLI::App& verb, SinkChoice& choice);

/// Which actuators a frame is for, where a board says how many it has.
enum class Driven { kThoseNamed, kAllOfTheBoard };

/// A sink that is open, and what is known of the other end.
class OpenSink {
 public:
  /// Opens it and, on a serial line, asks who is there: what a person should know of the answer goes to standard error.
  OpenSink(const SinkChoice& choice, const std::vector<std::string>& actuator_names, const CommonOptions& options,
           Driven driven = Driven::kThoseNamed);
  ~OpenSink();
  OpenSink(const OpenSink&) = delete;
  OpenSink& operator=(const OpenSink&) = delete;

  ActuatorSink& sink() const { return *sink_; }
  /// What the board said; nothing where none answered, or none was asked.
  const std::optional<Greeting>& greeting() const { return greeting_; }
  /// Warns where the board that answered drives fewer than these.
  void warn_of_actuators_beyond(std::size_t actuators, Verbosity verbosity) const;
  /// Finishes a file.
  void commit();

  /// What an XBee in API mode says of packets that it could not deliver; empty: nothing.
  std::string radio_failure() const;
  nlohmann::ordered_json link_json() const;
  /// A line or two for people, given the bytes that were sent.
  std::string describe_link(std::uint64_t bytes) const;

 private:
  /// A frame's time on the line, as 10 bits a byte.
  double line_time_s() const;

  SinkChoice choice_;
  std::unique_ptr<ActuatorSink> sink_;
  FrameFileSink* file_ = nullptr;
  SerialSink* serial_ = nullptr;
  std::optional<Greeting> greeting_;
  std::size_t frame_bytes_ = 0;  ///< of a state, on the line
};

}  // namespace vestige::cli
