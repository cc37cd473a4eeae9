#include "transport/sinks/bhaptics_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "traces/timeline/bhaptics_vest.hpp"

namespace vestige {

namespace {

constexpr std::string_view kScheme = "bhaptics";
/// The Player shows the name to its user.
constexpr const char* kPath = "/v2/feedbacks?app_id=vestige&app_name=Vestige";
constexpr std::chrono::seconds kPlayerPatience(1);

/// A request with a key replaces what plays under that key.
std::string key_of(std::string_view position) {
  return fmt::format("vestige {}", position);
}

}  // namespace

HostPort parse_bhaptics_url(std::string_view url) {
  return parse_host_port(url, kScheme, "--port", kBhapticsPort);
}

BhapticsSink::BhapticsSink(const BhapticsOptions& options, const std::vector<std::string>& actuator_names)
    : name_(host_port_url(kScheme, options.place)),
      duration_(options.duration),
      places_(bhaptics_places(actuator_names, name_)),
      client_(options.place, kPath, name_) {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    auto part = std::ranges::find(parts_, places_[i].position, &Part::position);
    if (part == parts_.end()) part = parts_.insert(part, {places_[i].position, {}});
    part->actuators.push_back(i);
  }
  client_.wait(kPlayerPatience);
}

bool BhapticsSink::ready() {
  return client_.is_free();
}

void BhapticsSink::send(const ActuatorFrame& frame, std::uint8_t) {
  send_text(state_text(frame.duty));
}

void BhapticsSink::send_off(std::uint8_t) {
  send_text(off_text());
}

std::vector<Acknowledgement> BhapticsSink::receive() {
  client_.work();
  require_open();
  return {};
}

bool BhapticsSink::reconnect() {
  client_.connect();
  client_.work();
  return client_.state() == WebsocketClient::State::kOpen;
}

std::string BhapticsSink::state_text(std::span<const std::uint8_t> level) const {
  std::string text = R"({"Submit":[)";
  for (const Part& part : parts_) {
    fmt::format_to(std::back_inserter(text), R"({}{{"Type":"frame","Key":"{}","Frame":{{"Position":"{}","DotPoints":[)",
                   &part == &parts_.front() ? "" : ",", key_of(part.position), part.position);
    for (const std::size_t i : part.actuators)
      fmt::format_to(std::back_inserter(text), R"({}{{"Index":{},"Intensity":{}}})",
                     i == part.actuators.front() ? "" : ",", places_[i].index,
                     i < level.size() ? bhaptics_intensity(level[i]) : 0);
    fmt::format_to(std::back_inserter(text), R"(],"PathPoints":[],"DurationMillis":{}}}}})", duration_.count());
  }
  return text + "]}";
}

std::string BhapticsSink::off_text() const {
  std::string text = R"({"Submit":[)";
  for (const Part& part : parts_)
    fmt::format_to(std::back_inserter(text), R"({}{{"Type":"turnOff","Key":"{}"}})",
                   &part == &parts_.front() ? "" : ",", key_of(part.position));
  return text + "]}";
}

void BhapticsSink::send_text(const std::string& text) {
  require_open();
  if (!client_.send(text)) require_open();
  bytes_sent_ += text.size();
  ++texts_sent_;
}

void BhapticsSink::require_open() const {
  if (client_.state() == WebsocketClient::State::kOpen) return;
  throw LinkLost(name_,
                 client_.state() == WebsocketClient::State::kConnecting
                     ? "bHaptics' Player does not answer"
                     : fmt::format("there is no connection to bHaptics' Player: {}", client_.failure()),
                 "start the Player on that PC, and see that no firewall blocks the port; it is looked for again");
}

}  // namespace vestige
