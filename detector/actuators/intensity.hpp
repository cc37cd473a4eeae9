#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/actuators/held_amplitudes.hpp"
#include "detector/contact.hpp"

namespace vestige {

struct LawOptions {
  double hold_s = 0.060;          ///< how long a contact is felt, since a coin motor cannot answer an instant; 0: raw
  double full_speed_m_per_s = 1;  ///< `speed`: what asks for all
  std::optional<double> sigma_m = std::nullopt;  ///< `gaussian`: none is half the layout's spacing
};

/// How strong each actuator is for the contacts of a frame: amplitudes 0 … 1, before any quantisation.
///
/// Contact on skin that no actuator covers asks for nothing, under every law. Of several contacts that ask for one
/// actuator, the strongest counts.
///
///   binary    A contact asks for its own actuator, fully (HAVE 2010 §III.B).
///   speed     Its own actuator, min(1, v / v_full), v being its speed along the triangle's normal.
///   phantom   The two or three actuators that it lies between, together as strong as one: A_i = sqrt(w_i), where the
///             w_i ≥ 0 add up to 1 and Σ w_i x_i is the contact's place. Between two, a share β of the way from the
///             first to the second, these are A_1 = sqrt(1 - β) and A_2 = sqrt(β) (Israr & Poupyrev 2011, "Tactile
///             Brush", the energy model). Places x_i are as the contact sees them: directions and distances along the
///             surface. Three are a triangle of `ActuatorLayout::neighbours`; a contact beyond the outermost actuators
///             is taken to the nearest place between two of them, or at one.
///   linear    The same with A_i = w_i: a phantom whose energy sags between actuators; to compare with.
///   gaussian  Every actuator, exp(-d² / 2σ²), d being the distance along the surface; less than half a duty's step is
///             nothing.
///
/// `binary` and `speed` hold every contact. Under the others a collider's next contact takes the place of the one that
/// is held, or the energy would grow along its way.
class IntensityLaw {
 public:
  virtual ~IntensityLaw() = default;
  IntensityLaw(const IntensityLaw&) = delete;
  IntensityLaw& operator=(const IntensityLaw&) = delete;

  virtual const char* name() const = 0;
  /// What the contacts of a row must carry.
  virtual PlaneSet planes() const = 0;
  /// What one contact asks for, whatever else there is: replaces `out`, each actuator at most once.
  virtual void spread(const LocatedContact& contact, std::vector<Share>& out) const = 0;

  /// The amplitudes at `time_s`, one for each actuator. `row`: a contact for each collider, as a detector with the
  /// layout's map makes it. Times must not decrease. The reference stays good until the next call.
  const std::vector<double>& next(double time_s, std::span<const Contact> row);

  /// Goes on with another layout of as many actuators; what is held stays.
  void change_layout(std::shared_ptr<const ActuatorLayout> layout) { layout_ = std::move(layout); }
  std::size_t actuator_count() const { return actuator_count_; }
  const LawOptions& options() const { return options_; }
  HeldAmplitudes::Rule hold_rule() const { return hold_rule_; }

 protected:
  /// `layout`: null for a law that does without.
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
};

/// The σ that `gaussian` uses; +inf for a layout of one actuator, which is then on wherever it is touched.
double sigma_of(const ActuatorLayout& layout, const LawOptions& options);

/// The names that a user may choose of.
inline constexpr const char* kLawNames[] = {"binary", "speed", "phantom", "gaussian"};

/// Whether a law asks where on the body a contact is; else the numbers of actuators are enough for it.
bool needs_layout(std::string_view law);

/// Makes a law by its name: of `kLawNames`, or "linear". Throws `UsageError` naming --law for any other.
std::unique_ptr<IntensityLaw> make_law(std::string_view name, std::shared_ptr<const ActuatorLayout> layout,
                                       const LawOptions& options);
/// The same for a law that does not need a layout.
std::unique_ptr<IntensityLaw> make_law(std::string_view name, std::size_t actuator_count, const LawOptions& options);

}  // namespace vestige
