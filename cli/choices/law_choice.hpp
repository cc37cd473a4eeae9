#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "detector/actuators/actuator_drive.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::cli {

/// The flags for what contacts mean to the actuators. They mean the same in every verb that drives actuators.
struct LawFlags {
  std::string law = "binary";
  std::optional<double> full_speed_m_per_s;
  std::optional<double> sigma_mm;
  std::string actuator;  ///< file of an `ActuatorModel`; empty for ideal motors
  double hold_ms = 60;

  /// Returns the options that the laws take. `hold_rate` is the number of trace seconds per second of the vest.
  LawOptions options(double hold_rate = 1) const;
  /// Throws `UsageError` for a flag that the law does not use.
  void check() const;
  /// Returns whether any flag, except --hold, differs from its default.
  bool any() const { return law != "binary" || !actuator.empty() || full_speed_m_per_s || sigma_mm; }
};

/// Adds --full-speed, --sigma, --actuator and --hold to a help group.
void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description);
/// Adds --law and the flags of `add_law_parameters`.
void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description);

/// Makes `ActuatorDrive`s: a law over a map, and the motors.
class DriveMaker {
 public:
  /// Checks the flags, reads --actuator, and measures the layout if the law needs one. Keeps a reference to the avatar.
  DriveMaker(const LawFlags& flags, const Avatar& avatar, const ActuatorMap& map, double hold_rate = 1);

  /// The planes that rows must carry.
  PlaneSet planes() const { return planes_; }
  bool has_layout() const { return layout_ != nullptr; }
  std::unique_ptr<ActuatorDrive> make() const;
  /// Returns the layout for another map with equally many actuators; null if the law needs no layout.
  std::shared_ptr<const ActuatorLayout> layout_of(const ActuatorMap& map) const;
  /// Sets the layout for the drives made from now on.
  void use(std::shared_ptr<const ActuatorLayout> layout) { layout_ = std::move(layout); }
  nlohmann::ordered_json to_json() const;

 private:
  LawFlags flags_;
  LawOptions options_;
  const Avatar& avatar_;
  std::size_t actuator_count_;
  std::vector<Motor> motors_;
  std::shared_ptr<const ActuatorLayout> layout_;
  PlaneSet planes_;
};

}  // namespace vestige::cli
