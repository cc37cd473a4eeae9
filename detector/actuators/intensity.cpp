#include "detector/actuators/intensity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
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

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// The actuators around a contact, and their weights, which add up to 1.
class Between {
 public:
  Between(const ActuatorLayout& layout, const LocatedContact& contact) : layout_(layout), contact_(contact) {
    const std::span<const float> distance_m = contact.distance_m();
    nearest_ = static_cast<std::uint16_t>(std::ranges::min_element(distance_m) - distance_m.begin());
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
      const float a_m = contact_.distance_m()[corner[0]];
      const float b_m = contact_.distance_m()[corner[1]];
      const float c_m = contact_.distance_m()[corner[2]];
      const std::pair<float, float> away_m = {std::max({a_m, b_m, c_m}), a_m + b_m + c_m};
      if (away_m >= best_m) continue;
      const std::array<glm::dvec2, 3> to = {towards(corner[0]), towards(corner[1]), towards(corner[2])};
      const std::array<double, 3> part = {cross(to[1], to[2]), cross(to[2], to[0]), cross(to[0], to[1])};
      const double whole = part[0] + part[1] + part[2];
      if (!(std::abs(whole) > 0)) continue;
      const std::array<double, 3> weight = {part[0] / whole, part[1] / whole, part[2] / whole};
      if (!(weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0)) continue;
      best_m = away_m;
      count_ = 0;
      for (std::size_t i = 0; i < 3; ++i)
        if (weight[i] > 0) weight_[count_++] = {corner[i], weight[i]};
    }
    return count_ != 0;
  }

  void find_edge() {
    const glm::dvec2 from = towards(nearest_);
    weight_[0] = {nearest_, 1};
    count_ = 1;
    double least = glm::dot(from, from);
    for (const std::uint16_t other : layout_.beside(nearest_)) {
      const glm::dvec2 way = towards(other) - from;
      const double length_squared = glm::dot(way, way);
      if (!(length_squared > 0)) continue;
      const double share = std::clamp(-glm::dot(from, way) / length_squared, 0.0, 1.0);
      const glm::dvec2 there = from + share * way;
      if (!(glm::dot(there, there) < least)) continue;
      least = glm::dot(there, there);
      count_ = 0;
      if (share < 1) weight_[count_++] = {nearest_, 1 - share};
      if (share > 0) weight_[count_++] = {other, share};
    }
  }

  /// Triangles share corners, so look up each corner once.
  glm::dvec2 towards(std::uint16_t actuator) {
    for (std::size_t i = 0; i < known_count_; ++i)
      if (known_[i].first == actuator) return known_[i].second;
    const glm::dvec2 way = layout_.towards_m(contact_, actuator);
    if (known_count_ < known_.size()) known_[known_count_++] = {actuator, way};
    return way;
  }

  const ActuatorLayout& layout_;
  const LocatedContact& contact_;
  std::uint16_t nearest_ = 0;
  std::array<std::pair<std::uint16_t, glm::dvec2>, 12> known_;  // the first known_count_ of them
  std::size_t known_count_ = 0;
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
    {"binary", "the contact's actuator, fully (the published law)",
     "A contact switches the actuator of its skin fully on (Spanlang et al. 2010, HAVE).", false, false,
     [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Binary>(count, options);
     }},
    {"speed", "the contact's actuator, by the speed of the impact",
     "The amplitude rises with the collider's speed along the skin's normal, up to a speed of full amplitude.", false,
     false,
     [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Speed>(count, options);
     }},
    {"phantom", "the actuators around the contact share its strength, so that it is felt between them",
     "The actuators around a contact share its amplitude at constant energy: for two, A₁ = √(1−β) A and A₂ = √β A "
     "(Israr & Poupyrev 2011, Tactile Brush).",
     true, false,
     [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Phantom>(layout, options, Energy::kEven);
     }},
    {"gaussian", "all actuators near the contact, by their distance along the skin",
     "Every actuator vibrates, with an amplitude that falls with its distance along the body: exp(−d²/2σ²).", true,
     false,
     [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Gaussian>(layout, options);
     }},
    {"linear", "",
     "The actuators share the amplitude as with phantom, but linearly, so the energy drops between them; for "
     "comparison.",
     true, false,
     [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Phantom>(layout, options, Energy::kSagging);
     }},
    {"depth", "the contact's actuator, by how deep a sphere is in the body",
     "The amplitude rises with how deep a sphere is in the body, up to a depth of full amplitude.", false, true,
     [](Layout, std::size_t count, const LawOptions& options) -> MadeLaw {
       return std::make_unique<Depth>(count, options);
     }},
    {"patch", "all actuators that a sphere covers, by how deep",
     "Every actuator vibrates that a touching sphere covers, with an amplitude that rises with how deep its place is "
     "in "
     "the sphere.",
     true, true,
     [](Layout layout, std::size_t, const LawOptions& options) -> MadeLaw {
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

void IntensityLaw::find_covered(const DetectorFrame& frame, std::uint32_t column) {
  located_.covered.clear();
  const auto segment = std::ranges::lower_bound(frame.segments, column, {}, &Segment::column);
  const glm::dvec3 centre(segment->end);
  const std::vector<std::optional<glm::dvec3>>& places = places_.now();
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    if (!places[i]) continue;
    const double depth_m = segment->radius_m - glm::distance(centre, *places[i]);
    if (depth_m > 0) located_.covered.push_back({i, depth_m});
  }
}

const std::vector<double>& IntensityLaw::next(double time_s, std::span<const Contact> row, const DetectorFrame* frame) {
  held_.begin(time_s);
  const bool asks_where = planes().has(Plane::kBarycentric);
  const bool asks_for_covered = this->asks_for_covered();
  if (asks_for_covered && frame != nullptr) places_.move(frame->palette);
  located_.covered.clear();
  for (std::uint32_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit() || (contact.actuator == 0 && !asks_for_covered)) continue;
    if (asks_for_covered) {
      if (frame != nullptr) find_covered(*frame, column);
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
