#include "cli/vest/sink_choice.hpp"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <set>
#include <utility>

#include "cli/choices/person_value.hpp"
#include "cli/help/validators.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/output_file.hpp"
#include "transport/sinks/bhaptics_sink.hpp"
#include "transport/sinks/osc_sink.hpp"
#include "transport/sinks/serial_sink.hpp"
#include "transport/sinks/wire_file_sink.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kVestGroup = "Vest";

/// The scheme of a URL may be in capitals (RFC 3986, section 3.1).
std::string with_small_scheme(std::string port) {
  for (const std::string_view scheme :
       {SinkChoice::kOscPrefix, SinkChoice::kBhapticsPrefix, SinkChoice::kFilePrefix, SinkChoice::kVmcPrefix})
    if (::strncasecmp(port.c_str(), scheme.data(), scheme.size()) == 0) port.replace(0, scheme.size(), scheme);
  return port;
}

std::uint64_t parse_address(const std::string& text) {
  std::uint64_t address = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), address, 16);
  if (failure != std::errc() || end != text.data() + text.size())
    throw UsageError("--xbee-address", fmt::format("'{}' is not an address", text),
                     "write at most 16 hexadecimal digits, as 0013A20041AABBCC; FFFF means every radio that listens");
  return address;
}

std::optional<XbeeOptions> xbee_options(const SinkChoice& choice) {
  if (!choice.xbee_api) return std::nullopt;
  return XbeeOptions{choice.xbee_request == "tx16" ? XbeeRequest::kTx16 : XbeeRequest::kTransmit,
                     choice.xbee_escaped ? XbeeEscaping::kEscaped : XbeeEscaping::kNone,
                     parse_address(choice.xbee_address)};
}

/// For ports that take poses and colliders: refuses ports of vests beside them, and flags of vests.
void check_played_flags(const CLI::App& verb, const std::vector<SinkChoice>& sinks) {
  const auto vest = std::ranges::find_if_not(sinks, &SinkChoice::is_vmc);
  if (vest != sinks.end())
    throw UsageError("--port",
                     fmt::format("'{}' drives a vest, and another port takes poses and colliders", vest->port),
                     "run 'vestige stream' once for each kind of port");
  const std::set<std::string> known = {"TRACE",   "--port",    "--rate",  "--loop", "--json",
                                       "--quiet", "--verbose", "--force", "--seed"};
  for (const CLI::Option* option : verb.get_options())
    if (option->count() != 0 && !known.contains(option->get_name()))
      throw UsageError(
          option->get_name(),
          fmt::format("does not apply to '{}', which takes poses and colliders: nothing is detected or felt here",
                      sinks.front().port),
          "leave it out");
}

/// Refuses flags that would say nothing, or not what they seem to.
void check_sink_flags(const CLI::App& verb, const std::vector<SinkChoice>& sinks) {
  const SinkChoice& first = sinks.front();
  if (std::ranges::any_of(sinks, &SinkChoice::is_vmc)) return check_played_flags(verb, sinks);
  if (first.ttl_ms % 10 != 0)
    throw UsageError("--ttl", fmt::format("a vest frame cannot hold {} ms", first.ttl_ms), "choose a multiple of 10");
  if (std::ranges::find(sinks, SinkChoice::kFilePrefix, &SinkChoice::port) != sinks.end())
    throw UsageError("--port", "names no file", "write file:OUT");
  for (const char* flag : {"--baud", "--xbee-api"})
    if (std::ranges::none_of(sinks, &SinkChoice::is_serial) && verb.count(flag) != 0)
      throw UsageError(flag, fmt::format("does not apply to '{}', which is not a serial port", first.port),
                       "leave it out");
  for (const char* flag : {"--osc-address", "--osc-value"})
    if (std::ranges::none_of(sinks, &SinkChoice::is_osc) && verb.count(flag) != 0)
      throw UsageError(flag, fmt::format("does not apply to '{}', which is not OSC", first.port),
                       "send to osc://HOST:PORT, or leave it out");
}

}  // namespace

SinkChoice SinkChoice::at(std::string other_port) const {
  SinkChoice other = *this;
  other.port = std::move(other_port);
  return other;
}

std::string SinkChoice::output_path() const {
  if (port == "-") return port;
  return port.starts_with(kFilePrefix) ? port.substr(kFilePrefix.size()) : "";
}

namespace {

/// Adds all but --port.
void add_sink_settings(CLI::App& verb, SinkChoice& choice, const std::string& levels_remark) {
  choice.baud = kDefaultBaud;
  const auto add = [&](const char* name, auto& value, const std::string& description) {
    return verb.add_option(name, value, description)->group(kVestGroup);
  };
  add("--baud", choice.baud, "Baud of the serial line; the board must be built for the same")
      ->capture_default_str()
      ->check(help::whole_number(1, 4'000'000))
      ->type_name("N");
  add("--ttl", choice.ttl_ms,
      "If no newer frame comes for this time, in ms, the board switches all actuators off; over OSC, a process beside "
      "this one does, and bHaptics' Player does after 60 ms at the latest. In steps of 10")
      ->capture_default_str()
      // A state that stays is sent again in time only where it lives so long (`ttl_units` takes less).
      ->check(help::whole_number(50, 2550))
      ->type_name("MS");
  add("--levels", choice.levels,
      "What the levels say. duty: duty cycles of vibrators; pressure: pressures of pneumatic cells" + levels_remark)
      ->capture_default_str()
      ->check(CLI::IsMember({"duty", "pressure"}));
  CLI::Option* xbee =
      verb.add_flag("--xbee-api", choice.xbee_api, "The XBee at this port is in API mode (its setting AP is not 0)")
          ->group(kVestGroup);
  add("--xbee-request", choice.xbee_request,
      "transmit: frame 0x10, 64-bit addresses; tx16: frame 0x01, 16-bit addresses, for the first XBee series")
      ->capture_default_str()
      ->check(CLI::IsMember({"transmit", "tx16"}))
      ->needs(xbee);
  add("--xbee-address", choice.xbee_address,
      "Address of the vest's radio, in hexadecimal; FFFF: every radio that listens")
      ->capture_default_str()
      ->type_name("HEX")
      ->needs(xbee);
  verb.add_flag("--xbee-escaped", choice.xbee_escaped, "The module's setting AP is 2")->group(kVestGroup)->needs(xbee);
  add("--osc-address", choice.osc_address,
      "Template of an actuator's OSC address: {n} is its number from 1, {i} from 0, {name} its name; bHaptics' bridge "
      "takes /avatar/parameters/bOSC/v2/VestFront/{i}/self [default: /avatar/parameters/vestige_{n}]")
      ->type_name("TEMPLATE");
  add("--osc-value", choice.osc_value, "float: level / 255; integer: 0 to 255; boolean: on and off")
      ->capture_default_str()
      ->check(CLI::IsMember({"float", "integer", "boolean"}));
}

void refuse_vmc(const SinkChoice& choice) {
  if (choice.is_vmc())
    throw UsageError("--port", fmt::format("'{}' takes poses and colliders, which is no vest", choice.port),
                     "name the port of a vest; 'vestige stream' sends poses there");
}

/// Adds --port, for one or for several.
/// `others` are further kinds of ports, `remark` follows all kinds.
CLI::Option* add_port(CLI::App& verb, auto& value, const std::string& others, const std::string& remark) {
  return verb
      .add_option("--port", value,
                  "Where frames go: a serial device (/dev/ttyUSB0: an XBee, or the board's USB); osc://HOST:PORT, "
                  "parameters over UDP; bhaptics://HOST, bHaptics' Player, at port 15881 unless :PORT follows; "
                  "file:OUT, a file of frames as on the wire; '-', the same on standard output" +
                      others + remark)
      ->group(kVestGroup)
      ->required()
      ->transform(CLI::Validator(
          [](std::string& port) {
            const std::size_t size = parse_person_value(port).value.size();
            port = port.substr(0, port.size() - size) + with_small_scheme(port.substr(port.size() - size));
            return std::string();
          },
          ""));
}

}  // namespace

void add_sink_options(CLI::App& verb, SinkChoice& choice) {
  add_port(verb, choice.port, "", "")->type_name("DEVICE|osc://HOST:PORT|bhaptics://HOST|file:OUT|-");
  add_sink_settings(verb, choice, "");
  verb.parse_complete_callback([&verb, &choice] {
    refuse_vmc(choice);
    check_sink_flags(verb, {choice});
  });
}

void add_sinks_options(CLI::App& verb, SinkChoice& settings, std::vector<std::string>& ports,
                       const std::string& levels_remark, VmcPorts vmc_ports) {
  const bool takes_vmc = vmc_ports == VmcPorts::kTaken;
  add_port(verb, ports,
           takes_vmc ? "; vmc://HOST:PORT: poses and colliders in the place of frames, as VR programs send them to "
                       "record --live"
                     : "",
           "; of several people, that of person K; repeat for more people")
      ->type_name(takes_vmc ? "[K=]DEVICE|osc://HOST:PORT|bhaptics://HOST|vmc://HOST:PORT|file:OUT|-"
                            : "[K=]DEVICE|osc://HOST:PORT|bhaptics://HOST|file:OUT|-")
      ->expected(1)
      ->take_all();
  add_sink_settings(verb, settings, levels_remark);
  verb.parse_complete_callback([&verb, &settings, &ports, takes_vmc] {
    std::vector<SinkChoice> sinks;
    sinks.reserve(ports.size());
    for (const std::string& port : ports) sinks.push_back(settings.at(parse_person_value(port).value));
    if (!takes_vmc) std::ranges::for_each(sinks, refuse_vmc);
    check_sink_flags(verb, sinks);
  });
}

namespace {

/// Of a frame for so many actuators, wrapping and all.
std::size_t state_bytes(const SinkChoice& choice, std::size_t actuators) {
  const auto frame = encode_state(choice.quantity(), std::vector<std::uint8_t>(actuators), 0, 1);
  const auto xbee = xbee_options(choice);
  return xbee ? xbee_wrap(*xbee, 1, frame).size() : frame.size();
}

}  // namespace

OpenSink::OpenSink(const SinkChoice& choice, const std::vector<std::string>& actuator_names,
                   const CommonOptions& options, Driven driven)
    : choice_(choice) {
  const Verbosity verbosity = options.verbosity();
  if (choice.is_osc()) {
    OscOptions osc = parse_osc_url(choice.port);
    if (!choice.osc_address.empty()) osc.address_template = choice.osc_address;
    osc.ttl = std::chrono::milliseconds(choice.ttl_ms);
    if (choice.osc_value == "integer") osc.value = OscValue::kInteger;
    if (choice.osc_value == "boolean") osc.value = OscValue::kBoolean;
    auto sink = std::make_unique<OscSink>(osc, actuator_names);
    if (sink->is_refused())
      warn(fmt::format("{}: no program listens there now; frames are sent anyway", sink->name()), verbosity);
    osc_ = sink.get();
    sink_ = std::move(sink);
    return;
  }
  if (choice.is_bhaptics()) {
    open_bhaptics(actuator_names);
    return;
  }
  if (choice.is_file()) {
    const std::string path = choice.output_path();
    if (path == "-") refuse_terminal("--port -");
    frame_bytes_ = state_bytes(choice, actuator_names.size());
    auto file = std::make_unique<WireFileSink>(path, options.overwrite(), choice.quantity(), ttl_units(choice.ttl_ms));
    file_ = file.get();
    sink_ = std::move(file);
    return;
  }
  SerialSinkOptions serial;
  serial.path = choice.port;
  serial.baud = choice.baud;
  serial.ttl_ms = choice.ttl_ms;
  serial.quantity = choice.quantity();
  serial.xbee = xbee_options(choice);
  auto sink = std::make_unique<SerialSink>(serial);
  greeting_ = sink->greet();
  if (!greeting_) {
    warn(
        fmt::format("{}: no board answers; frames are sent anyway\n  Check that the board is on, that it uses {} baud, "
                    "and that it runs the vest's program.",
                    choice.port, choice.baud),
        verbosity);
  }
  if (greeting_ && greeting_->outputs_failed)
    warn(fmt::format("{}: the board's output chips do not answer it, so all actuators stay off\n  Check the wires SDA "
                     "and SCL, the chips' addresses and their supply; the board's program is for {} chips.",
                     choice.port, chips_of(greeting_->actuator_count)),
         verbosity);
  std::size_t sent = actuator_names.size();
  if (greeting_) {
    const std::size_t told = greeting_->actuator_count;
    sent = driven == Driven::kAllOfTheBoard ? told : std::min(told, sent);
  }
  outputs_ = greeting_ ? greeting_->actuator_count : sent;
  frame_bytes_ = state_bytes(choice, sent);
  // Two may be on their way when the next one is due.
  if (2 * line_time_s() > choice.ttl_ms / 1e3)
    warn(fmt::format("{}: a frame takes {:.0f} ms on the line; if one frame is late or lost, the board switches itself "
                     "off\n  Use a faster --baud, or a longer --ttl.",
                     choice.port, line_time_s() * 1e3),
         verbosity);
  serial_ = sink.get();
  sink_ = std::move(sink);
}

OpenSink::~OpenSink() = default;

void OpenSink::open_bhaptics(const std::vector<std::string>& actuator_names) {
  constexpr int kRefreshesPlayed = 3;  // one or two refreshes may be late
  BhapticsOptions bhaptics;
  bhaptics.place = parse_bhaptics_url(choice_.port);
  bhaptics.duration =
      std::min(std::chrono::duration_cast<std::chrono::milliseconds>(SenderOptions().refresh) * kRefreshesPlayed,
               std::chrono::milliseconds(choice_.ttl_ms));
  auto sink = std::make_unique<BhapticsSink>(bhaptics, actuator_names);
  bhaptics_ = sink.get();
  sink_ = std::move(sink);
}

void OpenSink::warn_of_actuators_beyond(std::size_t actuators, Verbosity verbosity) const {
  if (greeting_ && greeting_->actuator_count < actuators)
    warn(fmt::format(
             "{}: the board drives only the first {} of {} actuators; the others are not felt\n  Use a map of at "
             "most {} actuators, or a board whose program is built for more (transport/firmware/README.md).",
             choice_.port, greeting_->actuator_count, actuators, greeting_->actuator_count),
         verbosity);
}

std::chrono::microseconds OpenSink::floor() const {
  std::chrono::microseconds floor = SenderOptions().floor;
  if (serial_ == nullptr) return floor;
  const std::chrono::duration<double> line(line_time_s());
  return std::max({floor, std::chrono::ceil<std::chrono::microseconds>(line), board_time(outputs_)});
}

std::chrono::microseconds OpenSink::refresh() const {
  return std::min<std::chrono::microseconds>(SenderOptions().refresh, std::chrono::milliseconds(choice_.ttl_ms) / 3);
}

void OpenSink::commit() {
  if (file_ != nullptr) file_->commit();
}

std::string OpenSink::radio_failure() const {
  const XbeeUnwrapper* radio = serial_ == nullptr ? nullptr : serial_->radio();
  if (radio == nullptr || radio->undelivered() == 0) return "";
  return fmt::format("the radio could not deliver {}: {}", counted(radio->undelivered(), "packet"),
                     xbee_failure(radio->last_failure()));
}

double OpenSink::line_time_s() const {
  return static_cast<double>(frame_bytes_) * kBitsPerByte / static_cast<double>(choice_.baud);
}

nlohmann::ordered_json OpenSink::link_json() const {
  nlohmann::ordered_json json = {{"port", choice_.port}};
  if (osc_ != nullptr) {
    json["datagrams"] = osc_->datagrams_sent();
    json["ttl_ms"] = choice_.ttl_ms;
    return json;
  }
  if (bhaptics_ != nullptr) {
    json["texts"] = bhaptics_->texts_sent();
    json["duration_ms"] = bhaptics_->duration().count();
    json["ttl_ms"] = choice_.ttl_ms;
    return json;
  }
  json["frame_bytes"] = frame_bytes_;
  if (choice_.is_file()) return json;
  json["baud"] = choice_.baud;
  json["line_time_us"] = line_time_s() * 1e6;
  json["ttl_ms"] = choice_.ttl_ms;
  json["xbee_api"] = choice_.xbee_api;
  if (greeting_) json["board"] = {{"version", greeting_->version}, {"actuators", greeting_->actuator_count}};
  return json;
}

std::string OpenSink::describe_link(std::uint64_t bytes) const {
  if (osc_ != nullptr)
    return fmt::format("{}: {} bytes in {}\n", sink_->name(), bytes, counted(osc_->datagrams_sent(), "datagram"));
  if (bhaptics_ != nullptr)
    return fmt::format("{}: {} bytes in {}\n", sink_->name(), bytes, counted(bhaptics_->texts_sent(), "text"));
  if (choice_.is_file()) return fmt::format("{}: {} bytes\n", sink_->name(), bytes);
  const std::string board = greeting_ ? fmt::format("board version {}, {}", greeting_->version,
                                                    counted(greeting_->actuator_count, "actuator"))
                                      : "no board answered";
  return fmt::format("{}: {}; {} bytes at {} baud, a frame of {} bytes takes {:.2f} ms on the line\n", choice_.port,
                     board, bytes, choice_.baud, frame_bytes_, line_time_s() * 1e3);
}

std::string doubt_about_off(const SenderStatistics& statistics, const ActuatorSink& sink) {
  if (!statistics.off_sent)
    return "the frames that switch all actuators off at the end could not be sent; a receiver that has a time-out "
           "switches them off itself";
  if (!sink.acknowledges() || statistics.off_acknowledged) return "";
  if (statistics.zeros_acknowledged)
    return "the last frame, OFF, was not acknowledged, but the state before it was, in which all levels are 0: the "
           "board may not know OFF";
  return "nothing confirms that all actuators are off at the end; a board that has a time-out switches them off itself";
}

}  // namespace vestige::cli
