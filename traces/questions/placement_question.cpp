#include "traces/questions/placement_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "traces/base/number_text.hpp"
#include "traces/questions/near_skin.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostKept = 128;
/// Fewer colliders than one in so many near the skin: something is asked.
constexpr std::size_t kFew = 100;
/// What is named must bring so many times as many near.
constexpr std::size_t kTimesMore = 10;
/// Where colliders do come near, what is named must fit so many times better; and so must an offset, which can be of
/// any size, than what needs no number.
constexpr double kTimesBetter = 4;
/// A simpler explanation is preferred if it brings this share of what the best one brings.
constexpr double kAlmostAsGood = 0.8;
/// Where another unit brings this share of it, which of the two is meant cannot be told.
constexpr double kAsGood = 0.5;
/// Colliders that a wrong unit draws together into one point are not where they were meant to be.
constexpr double kLeastExtent_m = 0.1;

/// The colliders of one frame as the file gave them, and the skin of that frame.
struct Moment {
  NearPoints skin;
  std::vector<std::uint32_t> ids;
  std::vector<glm::dvec3> given;
};

/// A way to understand the file.
struct Reading {
  Convention convention;
  std::string words;  ///< "in centimetres"
  std::string remedy;
  std::size_t changes = 1;  ///< the fewer, the simpler
  bool turns_only = false;  ///< axes or columns, not the unit
};

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const Pose& pose) {
  return is_finite(pose.origin_m) && std::ranges::all_of(pose.nodes, [](const NodeLocal& node) {
           const glm::quat& q = node.rotation;
           return is_finite(glm::dvec3(node.translation)) && is_finite(glm::dvec3(node.scale)) &&
                  is_finite(glm::dvec3(q.x, q.y, q.z)) && std::isfinite(q.w);
         });
}

/// How well colliders fit the body, by one reading.
struct Fit {
  std::size_t ids = 0;  ///< colliders that come near the skin
  double share = 0;     ///< of all samples that are near
  double height = 0;    ///< share of the body's height at which samples are near

  bool spreads = false;  ///< whether the colliders take more room than a point
  double weight = 1;     ///< less for what changes more

  /// A unit that makes the scene smaller packs samples more densely, by the third power, at so much less of the height.
  double score() const { return spreads ? weight * share * height * height * height : 0; }
};

Fit fit_of(const std::vector<Moment>& moments, const Convention& convention) {
  constexpr std::size_t kSlices = 10;
  std::set<std::uint32_t> near_ids;
  std::array<bool, kSlices> slices = {};
  std::size_t near = 0;
  std::vector<glm::dvec3> places;
  for (const Moment& moment : moments)
    for (std::size_t i = 0; i < moment.ids.size(); ++i) {
      const glm::dvec3& place_m = places.emplace_back(convention.position_m(moment.given[i]));
      if (!moment.skin.is_near(place_m)) continue;
      near_ids.insert(moment.ids[i]);
      ++near;
      const Box& box = moment.skin.box();
      const double up = (place_m.y - box.low.y) / std::max(box.extent().y, kLeastExtent_m);
      slices[static_cast<std::size_t>(std::clamp(up, 0.0, 0.999) * kSlices)] = true;
    }
  return {near_ids.size(), static_cast<double>(near) / static_cast<double>(places.size()),
          static_cast<double>(std::ranges::count(slices, true)) / kSlices,
          box_around(places).longest_side() >= kLeastExtent_m};
}

/// Takes long where colliders are near, since every point of the skin is looked at.
double nearest_m(const std::vector<Moment>& moments, const Convention& convention) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Moment& moment : moments)
    for (const glm::dvec3& given : moment.given)
      least_m = moment.skin.distance_m(convention.position_m(given), least_m);
  return least_m;
}

std::string_view unit_word(std::string_view unit) {
  if (unit == "cm") return "centimetres";
  if (unit == "mm") return "millimetres";
  return unit == "in" ? "inches" : "metres";
}

/// Every unit with every program's axes, and every order of columns.
std::vector<Reading> readings(const Convention& convention) {
  std::vector<Reading> found;
  std::vector<glm::dmat3> tried;
  for (const AxisPreset& preset : kAxisPresets) {
    const glm::dmat3 axes = axes_named(preset.name);
    if (std::ranges::find(tried, axes) != tried.end()) continue;
    tried.push_back(axes);
    for (const Unit& unit : kLengthUnits) {
      Convention other = convention;
      other.metres_per_unit = unit.size;
      other.axes = axes;
      if (other == convention) continue;
      const bool has_axes = axes != convention.axes;
      const bool has_unit = unit.size != convention.metres_per_unit;
      std::vector<std::string> words;
      if (has_unit) words.push_back(fmt::format("in {}", unit_word(unit.name)));
      if (has_axes) words.push_back(fmt::format("with the axes of {}", preset.name));
      std::vector<std::string> flags;
      if (has_axes) flags.push_back(fmt::format("--collider-axes {}", preset.name));
      if (has_axes ? unit.name != preset.unit : has_unit) flags.push_back(fmt::format("--collider-unit {}", unit.name));
      found.push_back({other, fmt::format("{}", fmt::join(words, " and ")), fmt::format("{}", fmt::join(flags, " ")),
                       flags.size(), !has_unit});
    }
  }
  std::array<int, 3> order = {0, 1, 2};
  while (std::ranges::next_permutation(order).found) {
    Convention other = convention;
    for (int column = 0; column < 3; ++column)
      other.axes[column] = convention.axes[order[static_cast<std::size_t>(column)]];
    const auto name = [&](std::size_t column) { return static_cast<char>('x' + order[column]); };
    found.push_back({other, fmt::format("with columns in the order {},{},{}", name(0), name(1), name(2)),
                     "put the columns in the order x,y,z", 2, true});
  }
  return found;
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Moves the colliders' middle into that of the body, to a tenth of a metre.
Reading moved(const std::vector<Moment>& moments, const Convention& convention, const glm::dvec3& origin_m) {
  std::array<std::vector<double>, 3> away;
  for (const Moment& moment : moments)
    for (const glm::dvec3& given : moment.given) {
      const glm::dvec3 distance = (moment.skin.box().low + moment.skin.box().high) * 0.5 - convention.position_m(given);
      for (int axis = 0; axis < 3; ++axis) away[static_cast<std::size_t>(axis)].push_back(distance[axis]);
    }
  Convention other = convention;
  for (int axis = 0; axis < 3; ++axis)
    other.offset_m[axis] += std::round(middle_of(std::move(away[static_cast<std::size_t>(axis)])) * 10) / 10;
  const glm::dvec3 by = other.offset_m - convention.offset_m;
  const glm::dvec3 offset = other.offset_m - origin_m;
  return {other, fmt::format("moved by {:.2g}, {:.2g}, {:.2g} m", by.x, by.y, by.z),
          fmt::format("--collider-offset={:.6g},{:.6g},{:.6g}", offset.x, offset.y, offset.z), 1};
}

}  // namespace

void PlacementQuestion::see(const TraceFrame& frame) {
  for (const ColliderSample& collider : frame.colliders) ids_.insert(collider.id);
  if (seen_++ % step_ != 0) return;
  kept_.push_back(frame);
  if (kept_.size() < 2 * kMostKept) return;
  for (std::size_t i = 0; i < kMostKept; ++i) std::swap(kept_[i], kept_[2 * i]);
  kept_.resize(kMostKept);
  step_ *= 2;
}

std::optional<std::string> PlacementQuestion::ask() const {
  std::vector<Moment> moments;
  for (const TraceFrame& frame : kept_) {
    if (frame.colliders.empty() || !is_finite(frame.pose)) continue;
    Moment moment = {NearPoints(sampler_.points_m(frame.pose)), {}, {}};
    for (const ColliderSample& collider : frame.colliders) {
      if (!is_finite(collider.position_m)) continue;
      moment.ids.push_back(collider.id);
      moment.given.push_back(convention_.given_position(collider.position_m));
    }
    if (!moment.ids.empty()) moments.push_back(std::move(moment));
  }
  if (moments.empty()) return std::nullopt;

  const Fit now = fit_of(moments, convention_);
  const bool few = now.ids * kFew < ids_.size();
  std::vector<Reading> tried = readings(convention_);
  // Where colliders do come near, nothing but wrong axes explains that others would do so more.
  if (!few) std::erase_if(tried, [&](const Reading& one) { return !one.turns_only; });
  // A body is about its own mirror image, so that only simplicity tells which of the two is meant.
  std::ranges::stable_sort(
      tried, {}, [](const Reading& one) { return std::pair(one.changes, glm::determinant(one.convention.axes) < 0); });
  std::vector<Fit> fits;
  fits.reserve(tried.size() + 1);
  double best = 0;
  const auto fit = [&](const Reading& reading) {
    const Fit& found = fits.emplace_back(fit_of(moments, reading.convention));
    const bool is_better = few ? found.ids >= std::max<std::size_t>(1, kTimesMore * now.ids)
                               : found.score() >= kTimesBetter * now.score() && found.ids >= now.ids;
    if (!is_better) fits.back() = {};
  };
  for (const Reading& reading : tried) {
    fit(reading);
    fits.back().weight = 1 / static_cast<double>(reading.changes);
    best = std::max(best, fits.back().score());
  }
  if (few) {
    fit(tried.emplace_back(moved(moments, convention_, origin_m_)));
    if (fits.back().score() > kTimesBetter * best) best = fits.back().score();
  }

  const std::string total = counted(ids_.size(), "collider");
  const std::string stays =
      now.ids == 0
          ? fmt::format("the nearest of {} stays {:.3g} m away from the skin", total, nearest_m(moments, convention_))
          : fmt::format("{} of {} come within {:g} cm of the skin, in {:.1f} % of all samples", now.ids, total,
                        NearPoints::kNear_m * 100, 100 * now.share);
  if (best == 0) return few ? std::optional(stays) : std::nullopt;
  const auto found = std::ranges::find_if(fits, [&](const Fit& one) { return one.score() >= kAlmostAsGood * best; });
  const Reading& reading = tried[static_cast<std::size_t>(found - fits.begin())];
  const std::string would = now.ids == 0 ? fmt::format("would come within {:g} cm", NearPoints::kNear_m * 100)
                                         : fmt::format("would, in {:.1f} %", 100 * found->share);
  std::string question = fmt::format("{}; {}, {} {}: {}", stays, reading.words, found->ids, would, reading.remedy);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const bool has_another_unit = tried[i].convention.metres_per_unit != reading.convention.metres_per_unit;
    if (has_another_unit && tried[i].changes == reading.changes && fits[i].score() >= kAsGood * found->score())
      question += fmt::format(" (or {}: {})", tried[i].words, tried[i].remedy);
  }
  return question;
}

}  // namespace vestige
