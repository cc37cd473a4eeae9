#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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
#include "detector/frame.hpp"

namespace vestige {

/// Half a step of a duty. Less rounds to 0, and is no vibration.
inline constexpr double kLeastAmplitude = 0.5 / 255;

struct LawOptions {
  double hold_s = 0.060;  ///< how long a contact is felt, since a coin motor cannot react within an instant; 0: raw
  std::optional<double> full_speed_m_per_s = 1;  ///< `speed`: the speed of full amplitude; never empty
  std::optional<double> full_depth_m = 0.010;    ///< `depth`, `patch`: the depth of full amplitude; never empty
  std::optional<double> sigma_m = std::nullopt;  ///< `gaussian`: if empty, half the layout's spacing
};

/// Computes how strongly each actuator vibrates for the contacts of a frame: amplitudes 0 … 1, before any quantisation.
///
/// A contact on skin without an actuator requests nothing, except under `patch`. If several contacts request one
/// actuator, the strongest request counts.
///
///   binary    A contact requests its own actuator at full amplitude (HAVE 2010 §III.B).
///   speed     Its own actuator at min(1, v / v_full), where v is the speed along the triangle's normal.
///   phantom   The two or three actuators around the contact, together as strong as one: A_i = sqrt(w_i), where the
///             w_i ≥ 0 add up to 1 and Σ w_i x_i is the contact's place. For two actuators, a share β of the way from
///             the first to the second gives A_1 = sqrt(1 - β) and A_2 = sqrt(β) (Israr & Poupyrev 2011, "Tactile
///             Brush", the energy model). Three actuators are a triangle of `ActuatorLayout::neighbours`, laid flat
///             with its sides as long as they are along the surface. The contact's place in it is the point whose
///             squared distances from the corners differ as the contact's do; on flat skin, that is the contact. A
///             contact beyond the outermost actuators moves to the nearest place between two of them, or at one.
///   linear    The same with A_i = w_i: a phantom whose energy sags between actuators, for comparison.
///   gaussian  Every actuator at exp(-d² / 2σ²), where d is the distance along the surface. Less than half a step of
///             the duty counts as nothing.
///   depth     Its own actuator at min(1, d / d_full), where d is how deep a sphere is in the body at the end of the
///             frame. A point is never deep.
///   patch     Every actuator whose place on the posed skin is within a sphere that touches, at
///             min(1, (r - distance) / d_full), where the distance is from the sphere's centre to the place, both at
///             the end of the frame.
///
/// Shares are those of the regions' own actuators. What these make vibrate, the map says (`Firing`).
///
/// `binary` and `speed` hold every contact: it is felt for `hold_s` more after the last frame of a touch. Under the
/// other laws, a collider's next contact replaces the held one. Otherwise the energy would grow along the collider's
/// way. A contact that requests nothing, such as one that leaves the actuators' skin, replaces none: what is held then
/// fades out after `hold_s`.
class IntensityLaw {
 public:
  virtual ~IntensityLaw() = default;
  IntensityLaw(const IntensityLaw&) = delete;
  IntensityLaw& operator=(const IntensityLaw&) = delete;

  virtual const char* name() const = 0;
  /// The planes that the contacts of a row must carry.
  virtual PlaneSet planes() const = 0;
  /// Whether `spread` asks which actuators a sphere covers.
  virtual bool asks_for_covered() const { return false; }
  /// Replaces `out` by the request of one contact, independent of all other contacts. Each region occurs at most once.
  virtual void spread(const LocatedContact& contact, std::vector<Share>& out) const = 0;

  /// Returns the amplitudes at `time_s`, one for each actuator. `row` has a contact for each collider, from a detector
  /// that uses the layout's map. `frame` is the frame that the contacts are of; a law that `asks_for_covered` needs it,
  /// unless there are none. Times must not decrease. The reference is valid until the next call.
  const std::vector<double>& next(double time_s, std::span<const Contact> row, const DetectorFrame* frame = nullptr);

  /// Returns what the sphere of a column covers; only for columns with a contact.
  using CoveredBy = std::function<std::span<const CoveredPlace>(std::uint32_t column)>;
  /// As above, where what spheres cover is known without a frame.
  const std::vector<double>& next(double time_s, std::span<const Contact> row, const CoveredBy& covered);

  /// Continues with another map of equally many actuators; the held amplitudes stay. `layout` is the map's, or null for
  /// a law that does not need one.
  void change_map(Firing firing, std::shared_ptr<const ActuatorLayout> layout) {
    firing_ = std::move(firing);
    layout_ = std::move(layout);
    if (asks_for_covered()) places_ = layout_->posed_places();
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
  PosedPlaces places_;  ///< only of a law that asks for covered places
  std::size_t actuator_count_;
  LawOptions options_;
  HeldAmplitudes::Rule hold_rule_;
  HeldAmplitudes held_;
  LocatedContact located_;
  std::vector<CoveredPlace> covered_;
  std::vector<Share> shares_;
  Firing firing_;
  std::vector<double> fired_;
};

/// Returns the σ that `gaussian` uses; +inf for a layout of one actuator, which is then fully on wherever it is
/// touched.
double sigma_of(const ActuatorLayout& layout, const LawOptions& options);

/// A number that a law takes, with its flag. Verbs, files and reports take all parameters from `law_parameters`.
struct LawParameter {
  std::array<std::string_view, 2> laws;  ///< the laws that take it; the second may be empty
  const char* flag;                      ///< such as "--sigma"
  const char* field;                     ///< its name in JSON, in the flag's unit
  const char* type_name;                 ///< for help
  const char* help;
  double per_unit;  ///< how many of the flag's unit are one of the option's: 1000 if the flag is in mm
  std::optional<double> LawOptions::*option;  ///< greater than 0
  /// Returns the value that the law uses, in the option's unit. `layout` is null if the law needs none.
  double (*used)(const LawOptions& options, const ActuatorLayout* layout);

  bool belongs_to(std::string_view law) const { return law == laws[0] || (!law.empty() && law == laws[1]); }
  /// The laws' names, for messages: "depth or patch".
  std::string owners() const;
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
  /// Whether it lets only spheres be felt.
  bool needs_radii = false;
  /// Whether it needs the frame that contacts are of (`IntensityLaw::asks_for_covered`).
  bool needs_poses = false;
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
