#include "detector/actuators/law_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

LawOptions LawFlags::options(double hold_rate) const {
  LawOptions options;
  options.hold_s = hold_ms / 1e3 * hold_rate;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    if (parameters[i]) options.*known.option = *parameters[i] / known.per_unit;
  }
  return options;
}

void LawFlags::check() const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const LawParameter& known = law_parameters()[i];
    if (parameters[i] && !known.belongs_to(law))
      throw UsageError(known.flag, fmt::format("has no effect with the law '{}'", law),
                       fmt::format("add --law {}, or leave this flag out", known.owners()));
  }
}

bool LawFlags::any() const {
  return law != "binary" || !actuator.empty() ||
         std::ranges::any_of(parameters, [](const std::optional<double>& given) { return given.has_value(); });
}

void require_spheres(std::span<const std::string> laws, bool has_spheres, const std::string& trace) {
  if (has_spheres) return;
  const auto law = std::ranges::find_if(laws, [](const std::string& name) { return law_named(name).needs_radii; });
  if (law == laws.end()) return;
  throw Error(trace, fmt::format("its colliders are points, and under the law {} only spheres are felt", *law),
              "choose another law, or record the colliders with a --radius");
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
  for (const LawParameter& known : law_parameters()) {
    if (!known.belongs_to(flags_.law)) continue;
    const double value = known.used(options_, layout_.get());
    if (std::isfinite(value)) json[known.field] = known.per_unit * value;
  }
  if (!flags_.actuator.empty()) json["actuator"] = flags_.actuator;
  return json;
}

LawMaker::Law LawMaker::make() {
  if (!drives_) {
    pressure_ = std::make_shared<PressureLaw>(actuator_count_, hold_s_);
    pressure_->change_map(firing_);
    return [law = pressure_](double time_s, const ContactRow& row, const DetectorFrame*) -> const ActuatorFrame& {
      return law->next(time_s, row);
    };
  }
  drive_ = drives_->make();
  return [drive = drive_](double time_s, const ContactRow& row, const DetectorFrame* frame) -> const ActuatorFrame& {
    return drive->next(time_s, row, frame);
  };
}

void LawMaker::use(const ActuatorMap& map, const std::shared_ptr<const ActuatorLayout>& layout) {
  firing_ = map.firing;
  if (pressure_) pressure_->change_map(map.firing);
  if (drives_) drives_->use(map, layout);
  if (drive_) drive_->law().change_map(map.firing, layout);
}

}  // namespace vestige
