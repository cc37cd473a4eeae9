#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"
#include "detector/contact.hpp"

namespace vestige {

/// Half a step of a duty. Less rounds to 0, and is no vibration.
inline constexpr double kLeastAmplitude = 0.5 / 255;

struct LawOptions {
  double hold_s = 0.060;  ///< how long a contact is felt, since a coin motor cannot react within an instant; 0: raw
  std::optional<double> full_speed_m_per_s = 1;  ///< `speed`: the speed of full amplitude; never empty
  std::optional<double> sigma_m = std::nullopt;  ///< `gaussian`: if empty, half the layout's spacing
};

/// Computes how strongly each actuator vibrates for the contacts of a frame: amplitudes 0 … 1, before any quantisation.
///
/// Under every law, a contact on skin without an actuator requests nothing. If several contacts request one actuator,
/// the strongest request counts.
///
///   binary    A contact requests its own actuator at full amplitude (HAVE 2010 §III.B).
///   speed     Its own actuator at min(1, v / v_full), where v is the speed along the triangle's normal.
///   phantom   The two or three actuators around the contact, together as strong as one: A_i = sqrt(w_i), where the
///             w_i ≥ 0 add up to 1 and Σ w_i x_i is the contact's place. For two actuators, a share β of the way from
///             the first to the second gives A_1 = sqrt(1 - β) and A_2 = sqrt(β) (Israr & Poupyrev 2011, "Tactile
///             Brush", the energy model). The places x_i are relative to the contact: directions and distances along
///             the surface. Three actuators are a triangle of `ActuatorLayout::neighbours`. A contact beyond the
///             outermost actuators moves to the nearest place between two of them, or at one.
///   linear    The same with A_i = w_i: a phantom whose energy sags between actuators, for comparison.
///   gaussian  Every actuator at exp(-d² / 2σ²), where d is the distance along the surface. Less than half a step of
///             the duty counts as nothing.
///
/// Shares are those of the regions' own actuators. What these make vibrate, the map says (`Firing`).
///
/// `binary` and `speed` hold every contact. Under the other laws, a collider's next contact replaces the held one.
/// Otherwise the energy would grow along the collider's way.
class IntensityLaw {
 public:
  virtual ~IntensityLaw() = default;
  IntensityLaw(const IntensityLaw&) = delete;
  IntensityLaw& operator=(const IntensityLaw&) = delete;

  virtual const char* name() const = 0;
  /// The planes that the contacts of a row must carry.
  virtual PlaneSet planes() const = 0;
  /// Replaces `out` by the request of one contact, independent of all other contacts. Each region occurs at most once.
  virtual void spread(const LocatedContact& contact, std::vector<Share>& out) const = 0;

  /// Returns the amplitudes at `time_s`, one for each actuator. `row` has a contact for each collider, from a detector
  /// that uses the layout's map. Times must not decrease. The reference is valid until the next call.
  const std::vector<double>& next(double time_s, std::span<const Contact> row);

  /// Continues with another map of equally many actuators; the held amplitudes stay. `layout` is the map's, or null for
  /// a law that does not need one.
  void change_map(Firing firing, std::shared_ptr<const ActuatorLayout> layout) {
    firing_ = std::move(firing);
    layout_ = std::move(layout);
  }
  std::size_t actuator_count() const { return actuator_count_; }
  const LawOptions& options() const { return options_; }
  HeldAmplitudes::Rule hold_rule() const { return hold_rule_; }

 protected:
  /// `layout` is null for a law that does not need one.
  IntensityLaw(std::shared_ptr<const ActuatorLayout> layout, std::size_t actuator_count, const LawOptions& options,
               HeldAmplitudes::Rule hold_rule);
  const ActuatorLayout& layout() const { return *layout_; }

 private:
  std::shared_ptr<const ActuatorLayout> layout_;
  std::size_t actuator_count_;
  LawOptions options_;
  HeldAmplitudes::Rule hold_rule_;
  HeldAmplitudes held_;
  LocatedContact located_;
  std::vector<Share> shares_;
  Firing firing_;
  std::vector<double> fired_;
};

/// Returns the σ that `gaussian` uses; +inf for a layout of one actuator, which is then fully on wherever it is
/// touched.
double sigma_of(const ActuatorLayout& layout, const LawOptions& options);

/// A number that one law takes, with its flag. Verbs, files and reports take all parameters from `law_parameters`.
struct LawParameter {
  const char* law;
  const char* flag;       ///< such as "--sigma"
  const char* field;      ///< its name in JSON, in the flag's unit
  const char* type_name;  ///< for help
  const char* help;
  double per_unit;  ///< how many of the flag's unit are one of the option's: 1000 if the flag is in mm
  std::optional<double> LawOptions::*option;  ///< greater than 0
  /// Returns the value that the law uses, in the option's unit. `layout` is null if the law needs none.
  double (*used)(const LawOptions& options, const ActuatorLayout* layout);
};

/// Returns the parameters of all laws, in the order of the help.
std::span<const LawParameter> law_parameters();

/// What a law is called, and what is said of it.
struct LawInfo {
  std::string_view name;
  std::string_view summary;      ///< for help, such as "the contact's actuator, fully"; empty: not offered to users
  std::string_view explanation;  ///< for reports: a sentence with its formula and source
  /// Whether it needs the place of a contact on the body. Otherwise the numbers of the actuators are enough.
  bool needs_layout = false;
  /// Precondition: `layout` is not null if the law needs one.
  std::unique_ptr<IntensityLaw> (*make)(std::shared_ptr<const ActuatorLayout> layout, std::size_t actuator_count,
                                        const LawOptions& options) = nullptr;
};

/// Returns all laws, in the order of the help.
std::span<const LawInfo> laws();
/// Returns the names that a user can choose from.
std::vector<std::string> law_names();
/// Returns the law of that name. Throws `UsageError` naming --law if there is none.
const LawInfo& law_named(std::string_view name);

std::unique_ptr<IntensityLaw> make_law(std::string_view name, std::shared_ptr<const ActuatorLayout> layout,
                                       const LawOptions& options);
/// As above. Precondition: the law does not need a layout.
std::unique_ptr<IntensityLaw> make_law(std::string_view name, const ActuatorMap& map, const LawOptions& options);

}  // namespace vestige
