#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "detector/actuators/actuator_drive.hpp"
#include "detector/actuators/pressure.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The flags for what contacts mean to the actuators. They mean the same in every verb that drives actuators.
struct LawFlags {
  std::string law = "binary";
  /// What is given for each of `law_parameters`, in the unit of its flag.
  std::vector<std::optional<double>> parameters = std::vector<std::optional<double>>(law_parameters().size());
  std::string actuator;  ///< file of an `ActuatorModel`; empty for ideal motors
  double hold_ms = 60;

  /// Returns the options that the laws take. `hold_rate` is the number of trace seconds per second of the vest.
  LawOptions options(double hold_rate = 1) const;
  /// Throws `UsageError` for a flag that the law does not use.
  void check() const;
  /// Returns whether any flag, except --hold, differs from its default.
  bool any() const;
};

/// Throws `Error` that quotes `trace` if one of the laws lets only spheres be felt, and the trace has none.
void require_spheres(std::span<const std::string> laws, bool has_spheres, const std::string& trace);

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
  /// Sets the map, with as many actuators and with its layout, for the drives made from now on.
  void use(const ActuatorMap& map, std::shared_ptr<const ActuatorLayout> layout) {
    firing_ = map.firing;
    layout_ = std::move(layout);
  }
  nlohmann::ordered_json to_json() const;

 private:
  LawFlags flags_;
  LawOptions options_;
  const Avatar& avatar_;
  std::size_t actuator_count_;
  Firing firing_;
  std::vector<Motor> motors_;
  std::shared_ptr<const ActuatorLayout> layout_;
  PlaneSet planes_;
};

/// Makes a law for each run through a trace: its contacts become duties of motors, or pressures.
class LawMaker {
 public:
  /// A law of one run; arguments as for `IntensityLaw::next`. The reference it returns stays good until the next call.
  using Law = std::function<const ActuatorFrame&(double time_s, const ContactRow& row, const DetectorFrame* frame)>;

  explicit LawMaker(DriveMaker drives) : drives_(std::move(drives)) {}
  /// For pressures, each held for `hold_s`.
  LawMaker(const ActuatorMap& map, double hold_s)
      : actuator_count_(map.actuator_count), firing_(map.firing), hold_s_(hold_s) {}

  PlaneSet planes() const { return drives_ ? drives_->planes() : kHashedPlanes | Plane::kPressure; }
  bool needs_layout() const { return drives_ && drives_->has_layout(); }
  nlohmann::ordered_json to_json() const { return drives_ ? drives_->to_json() : nlohmann::ordered_json("pressure"); }
  Law make();
  /// Uses another map from now on, in this run and those that follow. `layout` is the map's, or null for a law that
  /// does not need one.
  void use(const ActuatorMap& map, const std::shared_ptr<const ActuatorLayout>& layout);

 private:
  std::optional<DriveMaker> drives_;
  std::size_t actuator_count_ = 0;  ///< this and what follows: for pressures
  Firing firing_;
  double hold_s_ = 0;
  std::shared_ptr<ActuatorDrive> drive_;   ///< of the run that goes on
  std::shared_ptr<PressureLaw> pressure_;  ///< likewise
};

}  // namespace vestige
