#include "detector/actuators/intensity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "detector/actuators/portable_math.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

using Layout = std::shared_ptr<const ActuatorLayout>;
using Rule = HeldAmplitudes::Rule;

/// Laws whose contacts request only their own actuator, which the row's contacts carry.
constexpr PlaneSet kOwnActuator = Plane::kActuator;
/// Laws that need the place of a contact.
constexpr PlaneSet kPlace = Plane::kTriangle | Plane::kBarycentric | Plane::kTextureCoordinate;

class Binary final : public IntensityLaw {
 public:
  Binary(std::size_t actuator_count, const LawOptions& options)
      : IntensityLaw(nullptr, actuator_count, options, Rule::kEveryContact) {}
  const char* name() const override { return "binary"; }
  PlaneSet planes() const override { return kOwnActuator; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    if (contact.actuator != 0) out.push_back({contact.actuator - 1U, 1});
  }
};

class Speed final : public IntensityLaw {
 public:
  Speed(std::size_t actuator_count, const LawOptions& options)
      : IntensityLaw(nullptr, actuator_count, options, Rule::kEveryContact) {}
  const char* name() const override { return "speed"; }
  PlaneSet planes() const override { return kOwnActuator | Plane::kSpeed; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    const double share = contact.speed_m_per_s / options().full_speed_m_per_s.value();
    if (contact.actuator != 0 && share > 0) out.push_back({contact.actuator - 1U, std::min(share, 1.0)});
  }
};

/// The actuators around a contact, and their weights, which add up to 1. They follow from distances along the surface
/// alone, which change smoothly even where the shortest way to an actuator jumps to the other side of a limb.
class Between {
 public:
  Between(const ActuatorLayout& layout, const LocatedContact& contact)
      : layout_(layout), distance_m_(contact.distance_m()) {
    nearest_ = static_cast<std::uint16_t>(std::ranges::min_element(distance_m_) - distance_m_.begin());
    if (!find_triangle()) find_edge();
  }

  std::span<const Share> weights() const { return {weight_.data(), count_}; }

 private:
  bool find_triangle() {
    // Several triangles can contain the contact (two ways to cut a square, or one on the body's other side). Choose the
    // one with the nearest corners: first compare the farthest corner, then the sum of all.
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::pair<float, float> best_m = {kInfinity, kInfinity};
    for (const std::uint32_t number : layout_.neighbours_of(nearest_)) {
      const std::array<std::uint16_t, 3>& corner = layout_.neighbours()[number];
      const float a_m = distance_m_[corner[0]];
      const float b_m = distance_m_[corner[1]];
      const float c_m = distance_m_[corner[2]];
      const std::pair<float, float> away_m = {std::max({a_m, b_m, c_m}), a_m + b_m + c_m};
      if (away_m >= best_m) continue;
      const std::optional<std::array<double, 3>> weight = weights_in(corner);
      if (!weight || std::ranges::any_of(*weight, [](double share) { return !(share >= 0); })) continue;
      best_m = away_m;
      count_ = 0;
      for (std::size_t i = 0; i < 3; ++i)
        if ((*weight)[i] > 0) weight_[count_++] = {corner[i], (*weight)[i]};
    }
    return count_ != 0;
  }

  /// Lays the triangle flat, with its sides as long as they are along the surface, and finds the point that differs
  /// from the corners in squared distance as the contact does: on flat skin, the contact. Nothing if the corners are on
  /// a line.
  std::optional<std::array<double, 3>> weights_in(const std::array<std::uint16_t, 3>& corner) const {
    const double ab_m2 = squared_between_m2(corner[0], corner[1]);
    const double ac_m2 = squared_between_m2(corner[0], corner[2]);
    const double along = 0.5 * (ab_m2 + ac_m2 - squared_between_m2(corner[1], corner[2]));  // b . c, with a at 0
    const double area = ab_m2 * ac_m2 - along * along;
    if (!(area > 0)) return {};
    const double on_b = 0.5 * (squared_m2(corner[0]) - squared_m2(corner[1]) + ab_m2);  // the point . b
    const double on_c = 0.5 * (squared_m2(corner[0]) - squared_m2(corner[2]) + ac_m2);
    const double b = (on_b * ac_m2 - on_c * along) / area;
    const double c = (on_c * ab_m2 - on_b * along) / area;
    return {{1 - b - c, b, c}};
  }

  void find_edge() {
    const double from_m2 = squared_m2(nearest_);
    double best_m = std::sqrt(from_m2);  // to the contact, from the nearest place of an edge
    double second_m = std::numeric_limits<double>::infinity();
    Share best = {nearest_, 0};
    for (const std::uint16_t other : layout_.beside(nearest_)) {
      const double to_m2 = squared_m2(other);
      const double length_m2 = squared_between_m2(nearest_, other);
      if (!(length_m2 > 0)) continue;
      const double share = std::clamp(0.5 * (from_m2 - to_m2 + length_m2) / length_m2, 0.0, 1.0);
      if (!(share > 0)) continue;
      const double there_m =
          std::sqrt(std::max(0.0, (1 - share) * from_m2 + share * to_m2 - share * (1 - share) * length_m2));
      if (there_m < best_m) {
        if (best.amplitude > 0) second_m = best_m;
        best_m = there_m;
        best = {other, share};
      } else {
        second_m = std::min(second_m, there_m);
      }
    }
    // Where two edges are equally near, neither's other end may take part, or it would begin with a jump.
    if (second_m < (1 + kRamp) * best_m) best.amplitude *= (second_m / best_m - 1) / kRamp;
    weight_[0] = {nearest_, 1 - best.amplitude};
    count_ = 1;
    if (best.amplitude > 0) weight_[count_++] = best;
    if (best.amplitude >= 1) weight_[0] = weight_[--count_];
  }

  double squared_m2(std::uint16_t actuator) const {
    const auto distance_m = static_cast<double>(distance_m_[actuator]);
    return distance_m * distance_m;
  }
  double squared_between_m2(std::uint16_t a, std::uint16_t b) const {
    const double distance_m = layout_.between_m(a, b);
    return distance_m * distance_m;
  }

  static constexpr double kRamp = 0.1;
  const ActuatorLayout& layout_;
  std::span<const float> distance_m_;
  std::uint16_t nearest_ = 0;
  std::array<Share, 3> weight_ = {};
  std::size_t count_ = 0;
};

enum class Energy { kEven, kSagging };

class Phantom final : public IntensityLaw {
 public:
  Phantom(const Layout& layout, const LawOptions& options, Energy energy)
      : IntensityLaw(layout, layout->actuator_count(), options, Rule::kLatestOfCollider), energy_(energy) {}
  const char* name() const override { return energy_ == Energy::kEven ? "phantom" : "linear"; }
  PlaneSet planes() const override { return kPlace; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    if (contact.actuator == 0) return;
    const Between between(layout(), contact);
    for (const Share& weight : between.weights())
      out.push_back({weight.actuator, energy_ == Energy::kEven ? std::sqrt(weight.amplitude) : weight.amplitude});
  }

 private:
  Energy energy_;
};

class Gaussian final : public IntensityLaw {
 public:
  Gaussian(const Layout& layout, const LawOptions& options)
      : IntensityLaw(layout, layout->actuator_count(), options, Rule::kLatestOfCollider) {}
  const char* name() const override { return "gaussian"; }
  PlaneSet planes() const override { return kPlace; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    if (contact.actuator == 0) return;
    const double sigma_m = sigma_of(layout(), options());
    // A single actuator has no spacing, so it is on.
    const double scale = std::isfinite(sigma_m) ? 0.5 / (sigma_m * sigma_m) : 0;
    const auto reach_m = static_cast<float>(std::sqrt(kLogOfSteps / scale));
    const std::span<const float> distance_m = contact.distance_m();
    for (std::uint32_t i = 0; i < distance_m.size(); ++i) {
      if (distance_m[i] >= reach_m || !layout().place(i)) continue;
      const double squared = static_cast<double>(distance_m[i]) * static_cast<double>(distance_m[i]);
      const double amplitude = portable_exp(-squared * scale);
      if (amplitude >= kLeastAmplitude) out.push_back({i, std::min(amplitude, 1.0)});
    }
  }

 private:
  static constexpr double kLogOfSteps = 6.24;  // a little more than -ln(kLeastAmplitude)
};

/// Returns the amplitude of something that is `depth_m` deep.
double amplitude_of(double depth_m, const LawOptions& options) {
  return std::min(depth_m / options.full_depth_m.value(), 1.0);
}

class Depth final : public IntensityLaw {
 public:
  Depth(std::size_t actuator_count, const LawOptions& options)
      : IntensityLaw(nullptr, actuator_count, options, Rule::kLatestOfCollider) {}
  const char* name() const override { return "depth"; }
  PlaneSet planes() const override { return kOwnActuator | Plane::kDepth; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    if (contact.actuator == 0 || !(contact.depth_m > 0)) return;
    out.push_back({contact.actuator - 1U, amplitude_of(contact.depth_m, options())});
  }
};

class Patch final : public IntensityLaw {
 public:
  Patch(const Layout& layout, const LawOptions& options)
      : IntensityLaw(layout, layout->actuator_count(), options, Rule::kLatestOfCollider) {}
  const char* name() const override { return "patch"; }
  PlaneSet planes() const override { return kOwnActuator; }
  bool asks_for_covered() const override { return true; }
  void spread(const LocatedContact& contact, std::vector<Share>& out) const override {
    out.clear();
    for (const CoveredPlace& place : contact.covered)
      out.push_back({place.actuator, amplitude_of(place.depth_m, options())});
  }
};

using MadeLaw = std::unique_ptr<IntensityLaw>;

constexpr std::array<LawInfo, 7> kLaws = {{
    {.name = "binary",
     .summary = "the contact's actuator, fully (the published law)",
     .explanation = "A contact switches the actuator of its skin fully on (Spanlang et al. 2010, HAVE).",
     .make = [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Binary>(count, options);
     }},
    {.name = "speed",
     .summary = "the contact's actuator, by the speed of the impact",
     .explanation =
         "The amplitude rises with the collider's speed along the skin's normal, up to a speed of full amplitude.",
     .make = [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Speed>(count, options);
     }},
    {.name = "phantom",
     .summary = "the actuators around the contact share its strength, so that it is felt between them",
     .explanation = "The actuators around a contact share its amplitude at constant energy: for two, A₁ = √(1−β) A and "
                    "A₂ = √β A (Israr & Poupyrev 2011, Tactile Brush).",
     .needs_layout = true,
     .make = [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Phantom>(layout, options, Energy::kEven);
     }},
    {.name = "gaussian",
     .summary = "all actuators near the contact, by their distance along the skin",
     .explanation =
         "Every actuator vibrates, with an amplitude that falls with its distance along the body: exp(−d²/2σ²).",
     .needs_layout = true,
     .make = [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Gaussian>(layout, options);
     }},
    {.name = "linear",
     .summary = "",
     .explanation =
         "The actuators share the amplitude as with phantom, but linearly, so the energy drops between them; "
         "for comparison.",
     .needs_layout = true,
     .make = [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Phantom>(layout, options, Energy::kSagging);
     }},
    {.name = "depth",
     .summary = "the contact's actuator, by how deep a sphere is in the body",
     .explanation = "The amplitude rises with how deep a sphere is in the body, up to a depth of full amplitude.",
     .needs_radii = true,
     .make = [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Depth>(count, options);
     }},
    {.name = "patch",
     .summary = "all actuators whose places a sphere covers, by how deep",
     .explanation = "Every actuator vibrates whose place on the body a touching sphere covers, with an amplitude that "
                    "rises with how deep the place is in the sphere.",
     .needs_layout = true,
     .needs_radii = true,
     .needs_poses = true,
     .make = [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Patch>(layout, options);
     }},
}};

constexpr LawParameter kParameters[] = {
    {.laws = {"speed"},
     .flag = "--full-speed",
     .field = "full_speed_m_per_s",
     .type_name = "SPEED",
     .help = "With the law speed: the speed along the skin's normal that drives an actuator fully, in metres per "
             "second [default: 1]",
     .per_unit = 1,
     .option = &LawOptions::full_speed_m_per_s,
     .used = [](const LawOptions& options, const ActuatorLayout*) { return options.full_speed_m_per_s.value(); }},
    {.laws = {"depth", "patch"},
     .flag = "--full-depth",
     .field = "full_depth_mm",
     .type_name = "MM",
     .help = "With the laws depth and patch: the depth that drives an actuator fully, in mm [default: 10]",
     .per_unit = 1e3,
     .option = &LawOptions::full_depth_m,
     .used = [](const LawOptions& options, const ActuatorLayout*) { return options.full_depth_m.value(); }},
    {.laws = {"gaussian"},
     .flag = "--sigma",
     .field = "sigma_mm",
     .type_name = "MM",
     .help = "With the law gaussian: the width (standard deviation) of a contact, in mm along the skin [default: half "
             "the median distance between neighbouring actuators]",
     .per_unit = 1e3,
     .option = &LawOptions::sigma_m,
     .used = [](const LawOptions& options, const ActuatorLayout* layout) { return sigma_of(*layout, options); }},
};

}  // namespace

double sigma_of(const ActuatorLayout& layout, const LawOptions& options) {
  return options.sigma_m.value_or(0.5 * layout.spacing_m());
}

IntensityLaw::IntensityLaw(Layout layout, std::size_t actuator_count, const LawOptions& options, Rule hold_rule)
    : layout_(std::move(layout)),
      actuator_count_(actuator_count),
      options_(options),
      hold_rule_(hold_rule),
      held_(actuator_count, options.hold_s, hold_rule) {}

const std::vector<double>& IntensityLaw::next(double time_s, std::span<const Contact> row, const DetectorFrame* frame) {
  if (asks_for_covered() && frame != nullptr) places_.move(frame->palette);
  return next(time_s, row, [&](std::uint32_t column) {
    covered_.clear();
    if (frame != nullptr) places_.covered_by(column, *frame, covered_);
    return std::span<const CoveredPlace>(covered_);
  });
}

const std::vector<double>& IntensityLaw::next(double time_s, std::span<const Contact> row, const CoveredBy& covered) {
  held_.begin(time_s);
  const bool asks_where = planes().has(Plane::kBarycentric);
  const bool asks_for_covered = this->asks_for_covered();
  for (std::uint32_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit() || (contact.actuator == 0 && !asks_for_covered)) continue;
    if (asks_for_covered) {
      located_.covered = covered(column);
    } else if (asks_where) {
      layout_->locate(contact, located_);
    } else {
      located_.speed_m_per_s = contact.speed_m_per_s;
      located_.depth_m = contact.depth_m;
    }
    located_.actuator = contact.actuator;
    spread(located_, shares_);
    held_.add(column, shares_);
  }
  return firing_.apply(held_.now(), fired_);
}

std::span<const LawParameter> law_parameters() {
  return kParameters;
}

std::span<const LawInfo> laws() {
  return kLaws;
}

std::string LawParameter::owners() const {
  return laws[1].empty() ? std::string(laws[0]) : fmt::format("{} or {}", laws[0], laws[1]);
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  names.reserve(kLaws.size());
  for (const LawInfo& law : kLaws)
    if (!law.summary.empty()) names.emplace_back(law.name);
  return names;
}

const LawInfo& law_named(std::string_view name) {
  const auto found = std::ranges::find(kLaws, name, &LawInfo::name);
  if (found == kLaws.end())
    throw UsageError("--law", fmt::format("there is no intensity law '{}'", name),
                     fmt::format("choose one of: {}", fmt::join(law_names(), ", ")));
  return *found;
}

std::unique_ptr<IntensityLaw> make_law(std::string_view name, Layout layout, const LawOptions& options) {
  auto law = law_named(name).make(layout, layout->actuator_count(), options);
  law->change_map(layout->map().firing, layout);
  return law;
}

std::unique_ptr<IntensityLaw> make_law(std::string_view name, const ActuatorMap& map, const LawOptions& options) {
  auto law = law_named(name).make(nullptr, map.actuator_count, options);
  law->change_map(map.firing, nullptr);
  return law;
}

}  // namespace vestige
