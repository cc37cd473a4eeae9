#include "detector/actuators/law_maker.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

void refuse_unless(bool is_right, const char* flag, const std::string& law, const char* knower) {
  if (!is_right)
    throw UsageError(flag, fmt::format("has no effect with the law '{}'", law),
                     fmt::format("add --law {}, or leave this flag out", knower));
}

}  // namespace

LawOptions LawFlags::options(double hold_rate) const {
  LawOptions options;
  options.hold_s = hold_ms / 1e3 * hold_rate;
  if (full_speed_m_per_s) options.full_speed_m_per_s = *full_speed_m_per_s;
  if (sigma_mm) options.sigma_m = *sigma_mm / 1e3;
  return options;
}

void LawFlags::check() const {
  refuse_unless(!full_speed_m_per_s || law == "speed", "--full-speed", law, "speed");
  refuse_unless(!sigma_mm || law == "gaussian", "--sigma", law, "gaussian");
}

DriveMaker::DriveMaker(const LawFlags& flags, const Avatar& avatar, const ActuatorMap& map, double hold_rate)
    : flags_(flags),
      options_(flags.options(hold_rate)),
      avatar_(avatar),
      actuator_count_(map.actuator_count),
      firing_(map.firing) {
  flags.check();
  if (!flags.actuator.empty()) motors_ = read_actuator_model(flags.actuator).motors(map);
  for (Motor& motor : motors_) motor.kick_s *= hold_rate;
  layout_ = layout_of(map);
  planes_ = kHashedPlanes | make()->law().planes();
}

std::unique_ptr<ActuatorDrive> DriveMaker::make() const {
  auto law = law_named(flags_.law).make(layout_, actuator_count_, options_);
  law->change_map(firing_, layout_);
  return std::make_unique<ActuatorDrive>(std::move(law), motors_);
}

std::shared_ptr<const ActuatorLayout> DriveMaker::layout_of(const ActuatorMap& map) const {
  return law_named(flags_.law).needs_layout ? std::make_shared<ActuatorLayout>(avatar_, map) : nullptr;
}

nlohmann::ordered_json DriveMaker::to_json() const {
  nlohmann::ordered_json json = {{"name", flags_.law}, {"hold_ms", flags_.hold_ms}};
  if (flags_.law == "speed") json["full_speed_m_per_s"] = options_.full_speed_m_per_s;
  if (flags_.law == "gaussian" && std::isfinite(sigma_of(*layout_, options_)))
    json["sigma_mm"] = 1e3 * sigma_of(*layout_, options_);
  if (!flags_.actuator.empty()) json["actuator"] = flags_.actuator;
  return json;
}

LawMaker::Law LawMaker::make() {
  if (!drives_) {
    pressure_ = std::make_shared<PressureLaw>(actuator_count_, hold_s_);
    pressure_->change_map(firing_);
    return [law = pressure_](double time_s, const ContactRow& row) -> const ActuatorFrame& {
      return law->next(time_s, row);
    };
  }
  drive_ = drives_->make();
  return [drive = drive_](double time_s, const ContactRow& row) -> const ActuatorFrame& {
    return drive->next(time_s, row);
  };
}

void LawMaker::use(const ActuatorMap& map, const std::shared_ptr<const ActuatorLayout>& layout) {
  firing_ = map.firing;
  if (pressure_) pressure_->change_map(firing_);
  if (drives_) drives_->use(map, layout);
  if (drive_) drive_->law().change_map(firing_, layout);
}

}  // namespace vestige
