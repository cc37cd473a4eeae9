#include "cli/choices/law_choice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "cli/help/validators.hpp"
#include "detector/actuators/actuator_model.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kLawDescription =
    "How strong actuators are for a contact:\n"
    "  binary   its own, fully (the published law)\n"
    "  speed    its own, by the speed of the impact\n"
    "  phantom  those that it lies between share it, so that it is felt in between\n"
    "  gaussian all near it, by their distance along the skin";

void refuse_unless(bool is_right, const char* flag, const std::string& law, const char* knower) {
  if (!is_right)
    throw UsageError(flag, fmt::format("means nothing to the law '{}'", law),
                     fmt::format("add --law {}, or leave it out", knower));
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

void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description) {
  const std::vector<std::string> names(std::begin(kLawNames), std::end(kLawNames));
  verb.add_option("--law", flags.law, kLawDescription)
      ->group(group)
      ->capture_default_str()
      ->check(CLI::IsMember(names))
      ->type_name("LAW");
  add_law_parameters(verb, flags, group, hold_description);
}

void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group,
                        const std::string& hold_description) {
  verb.add_option("--full-speed", flags.full_speed_m_per_s,
                  "With --law speed: the speed along the skin's normal that asks for all, in metres per second "
                  "[default: 1]")
      ->group(group)
      ->check(help::kPositive)
      ->type_name("SPEED");
  verb.add_option("--sigma", flags.sigma_mm,
                  "With --law gaussian: how wide a contact is felt, in mm along the skin [default: half the median "
                  "distance between neighbours]")
      ->group(group)
      ->check(help::kPositive)
      ->type_name("MM");
  verb.add_option("--actuator", flags.actuator,
                  "The motors, as JSON: what duty makes what amplitude, and a kick that starts them")
      ->group(group)
      ->type_name("FILE.json");
  verb.add_option("--hold", flags.hold_ms, hold_description)
      ->group(group)
      ->capture_default_str()
      ->check(help::kNotNegative)
      ->type_name("MS");
}

DriveMaker::DriveMaker(const LawFlags& flags, const Avatar& avatar, const ActuatorMap& map, double hold_rate)
    : flags_(flags), options_(flags.options(hold_rate)), avatar_(avatar), actuator_count_(map.actuator_count) {
  flags.check();
  if (!flags.actuator.empty()) motors_ = read_actuator_model(flags.actuator).motors(map);
  for (Motor& motor : motors_) motor.kick_s *= hold_rate;
  layout_ = layout_of(map);
  planes_ = kHashedPlanes | make()->law().planes();
}

std::unique_ptr<ActuatorDrive> DriveMaker::make() const {
  auto law = layout_ ? make_law(flags_.law, layout_, options_) : make_law(flags_.law, actuator_count_, options_);
  return std::make_unique<ActuatorDrive>(std::move(law), motors_);
}

std::shared_ptr<const ActuatorLayout> DriveMaker::layout_of(const ActuatorMap& map) const {
  return vestige::needs_layout(flags_.law) ? std::make_shared<ActuatorLayout>(avatar_, map) : nullptr;
}

nlohmann::ordered_json DriveMaker::to_json() const {
  nlohmann::ordered_json json = {{"name", flags_.law}, {"hold_ms", flags_.hold_ms}};
  if (flags_.law == "speed") json["full_speed_m_per_s"] = options_.full_speed_m_per_s;
  if (flags_.law == "gaussian" && std::isfinite(sigma_of(*layout_, options_)))
    json["sigma_mm"] = 1e3 * sigma_of(*layout_, options_);
  if (!flags_.actuator.empty()) json["actuator"] = flags_.actuator;
  return json;
}

}  // namespace vestige::cli
