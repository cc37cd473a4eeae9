#include "detector/actuators/actuator_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "detector/actuators/portable_math.hpp"
#include "traces/base/error.hpp"
#include "traces/base/strict_json.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

constexpr const char* kRemedy =
    R"(write for example {"duty": {"gamma": 0.5}, "dead_zone": 0.2, "rise_ms": 60, "fall_ms": 60, "kick_ms": 0})";

std::uint8_t to_duty(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

class Parser {
 public:
  Parser(const nlohmann::json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) throw Error(where_, "is not a JSON object", kRemedy);
  }

  Motor parse(Motor motor, bool is_one_actuator) const {
    for (const auto& [key, value] : object_.items()) {
      if (key == "duty") {
        motor.curve = curve(value);
      } else if (key == "dead_zone") {
        motor.dead_zone = number(key, value, 0, 1);
      } else if (key == "felt_threshold") {
        motor.felt_threshold = number(key, value, 0, 1);
      } else if (key == "rise_ms") {
        motor.rise_s = time_s(key, value);
      } else if (key == "fall_ms") {
        motor.fall_s = time_s(key, value);
      } else if (key == "kick_ms") {
        motor.kick_s = number(key, value, 0, 1e4) / 1e3;
      } else if (!(is_one_actuator ? key == "name" : key == "actuators")) {
        throw Error(where_, fmt::format("has a field '{}' that does not describe a motor", key),
                    "the fields are: duty, dead_zone, rise_ms, fall_ms, kick_ms, felt_threshold, actuators");
      }
    }
    if (motor.dead_zone == 1) throw Error(where_, "'dead_zone' is 1, so the motor never turns", "write a lower value");
    return motor;
  }

 private:
  double number(const std::string& key, const nlohmann::json& value, double low, double high) const {
    if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
      throw Error(where_, fmt::format("'{}' is not a number from {} to {}", key, low, high), kRemedy);
    return value.get<double>();
  }

  double time_s(const std::string& key, const nlohmann::json& value) const {
    const double time_ms = number(key, value, 0, 1e4);
    if (time_ms == 0) throw Error(where_, fmt::format("'{}' is 0", key), "write 0.1 or more: no motor is faster");
    return time_ms / 1e3;
  }

  std::array<std::uint8_t, 256> curve(const nlohmann::json& value) const {
    const bool has_gamma = value.is_object() && value.size() == 1 && value.contains("gamma");
    const bool has_table = value.is_object() && value.size() == 1 && value.contains("table");
    if (!has_gamma && !has_table) throw Error(where_, "'duty' is neither {\"gamma\": …} nor {\"table\": […]}", kRemedy);
    std::array<std::uint8_t, 256> curve = {};
    if (has_gamma) {
      const double gamma = number("gamma", value["gamma"], 0.01, 100);
      for (std::size_t i = 1; i < curve.size(); ++i)
        curve[i] = to_duty(portable_pow(static_cast<double>(i) / 255, gamma));
      return curve;
    }
    const std::vector<std::pair<double, double>> table = read_table(value["table"]);
    for (std::size_t i = 1; i < curve.size(); ++i) {
      const double amplitude = static_cast<double>(i) / 255;
      std::size_t k = 1;
      while (table[k].first < amplitude && k + 1 < table.size()) ++k;
      const auto& [from, from_duty] = table[k - 1];
      const auto& [to, to_duty_share] = table[k];
      curve[i] = to_duty(from_duty + (amplitude - from) / (to - from) * (to_duty_share - from_duty));
    }
    return curve;
  }

  std::vector<std::pair<double, double>> read_table(const nlohmann::json& value) const {
    const auto refuse = [&] {
      return Error(where_,
                   "'table' is not a list of pairs [amplitude, share of full duty] that rises from amplitude 0 to 1",
                   R"(write for example {"table": [[0, 0], [0.1, 0.4], [1, 1]]})");
    };
    if (!value.is_array() || value.size() < 2) throw refuse();
    std::vector<std::pair<double, double>> table;
    for (const nlohmann::json& pair : value) {
      if (!pair.is_array() || pair.size() != 2 || !pair[0].is_number() || !pair[1].is_number()) throw refuse();
      const std::pair<double, double> entry = {pair[0].get<double>(), pair[1].get<double>()};
      if (!(entry.second >= 0 && entry.second <= 1)) throw refuse();
      if (!table.empty() && !(entry.first > table.back().first && entry.second >= table.back().second)) throw refuse();
      table.push_back(entry);
    }
    if (table.front().first != 0 || table.back().first != 1) throw refuse();
    return table;
  }

  const nlohmann::json& object_;
  std::string where_;
};

}  // namespace

std::array<std::uint8_t, 256> Motor::straight() {
  std::array<std::uint8_t, 256> curve = {};
  for (std::size_t i = 0; i < curve.size(); ++i) curve[i] = static_cast<std::uint8_t>(i);
  return curve;
}

std::uint8_t Motor::duty(double amplitude) const {
  return curve[to_duty(amplitude)];
}

double Motor::settled(std::uint8_t duty) const {
  const double share = duty / 255.0;
  return share > dead_zone ? (share - dead_zone) / (1 - dead_zone) : 0;
}

double Motor::after(double amplitude, std::uint8_t duty, double duration_s) const {
  const double target = settled(duty);
  const double tau_s = target > amplitude ? rise_s : fall_s;
  return target + (amplitude - target) * portable_exp(-duration_s / tau_s);
}

std::vector<Motor> ActuatorModel::motors(const ActuatorMap& map) const {
  std::vector<Motor> motors(map.actuator_count, all_);
  for (const auto& [name, motor] : named_) {
    const auto found = std::ranges::find(map.names, name);
    if (found == map.names.end())
      throw Error(name_, fmt::format("names an actuator '{}' that the map does not have", name),
                  fmt::format("the map's actuators are: {}", fmt::join(map.names, ", ")));
    motors[static_cast<std::size_t>(found - map.names.begin())] = motor;
  }
  return motors;
}

ActuatorModel parse_actuator_model(std::string_view json, std::string_view name) {
  const nlohmann::json document = parse_strict_json(json, name, kRemedy);
  ActuatorModel model;
  model.name_ = name;
  model.all_ = Parser(document, std::string(name)).parse(Motor(), false);
  if (!document.contains("actuators")) return model;
  if (!document["actuators"].is_array()) throw Error(name, "'actuators' is not a list", kRemedy);
  for (const nlohmann::json& entry : document["actuators"]) {
    const std::string where = fmt::format("{}, actuators[{}]", name, model.named_.size());
    const Motor motor = Parser(entry, where).parse(model.all_, true);
    if (!entry.contains("name") || !entry["name"].is_string())
      throw Error(where, "has no 'name'", "write an actuator's name as it stands in the map's sidecar");
    const auto actuator = entry["name"].get<std::string>();
    if (std::ranges::find(model.named_, actuator, &std::pair<std::string, Motor>::first) != model.named_.end())
      throw Error(where, fmt::format("actuator '{}' is listed twice", actuator), "remove one of them");
    model.named_.emplace_back(actuator, motor);
  }
  return model;
}

ActuatorModel read_actuator_model(const std::string& file) {
  return parse_actuator_model(read_text_file(file), file);
}

}  // namespace vestige
