#include "analysis/mapping/region_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <set>

#include "analysis/mapping/skin_patches.hpp"
#include "detector/actuators/surface_distance.hpp"

namespace vestige {

namespace {

/// Sampling step on the skin for a region's extent and middle, as a share of the body's longest side.
constexpr double kPlanStep = 0.005;
constexpr double kMostSamples = 1 << 20;
/// The number of heights at which the axis between front and back is computed.
constexpr std::size_t kAxisPoints = 24;

/// "*" in the pattern stands for any letters.
bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;
  std::size_t star_text = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  return pattern.substr(p).find_first_not_of('*') == std::string_view::npos;
}

/// Returns whether an angle lies in an interval, up to whole turns of either.
bool is_within(double degrees, const Extent& interval) {
  const double beyond = degrees - interval.low;
  return beyond - 360 * std::floor(beyond / 360) < interval.high - interval.low;
}

Extent angles_of(const std::string& side) {
  if (side == "front") return {-90, 90};
  if (side == "back") return {90, 270};
  if (side == "left") return {0, 180};
  return {-180, 0};
}

/// Returns the angles of a grid's columns: those asked for, otherwise those that the sides leave.
Extent column_angles(const RegionSpec& spec, const std::string& where) {
  if (spec.angle_degrees) return *spec.angle_degrees;
  const auto has = [&](const char* side) { return std::ranges::find(spec.sides, side) != spec.sides.end(); };
  if ((has("front") && has("back")) || (has("left") && has("right")))
    throw Error(where, "asks for two opposite sides at once", "write them as two regions");
  if (has("left") || has("right")) {
    if (has("front")) return has("left") ? Extent{0, 90} : Extent{-90, 0};
    if (has("back")) return has("left") ? Extent{90, 180} : Extent{180, 270};
    return angles_of(has("left") ? "left" : "right");
  }
  if (has("front") || has("back")) return angles_of(has("front") ? "front" : "back");
  return {0, 360};
}

/// Returns which of `count` equal pieces of the interval has the value.
std::size_t piece(double value, const Extent& interval, std::size_t count) {
  const double share = (value - interval.low) / (interval.high - interval.low);
  const double number = std::floor(share * static_cast<double>(count));
  return static_cast<std::size_t>(std::clamp(number, 0.0, static_cast<double>(count - 1)));
}

/// Returns whether up, left or front decide about the region's skin.
bool needs_standing(const RegionSpec& spec, Understanding understanding) {
  const auto has_side = [&](const std::string& part) {
    return understanding == Understanding::kProportions || part.starts_with("vest") || part.ends_with(" left") ||
           part.ends_with(" right");
  };
  return spec.height || spec.height_m || spec.angle_degrees || !spec.sides.empty() || spec.grid ||
         std::ranges::any_of(spec.parts, has_side) ||
         !std::ranges::all_of(spec.actuators, [](const RegionActuator& one) { return one.position_m.has_value(); });
}

SkinPatches sampled(const BodySurface& surface, std::uint32_t triangle, double step) {
  return patches_of_length(surface, triangle, step * kPlanStep * surface.bounds().longest_side());
}

}  // namespace

double RegionPlan::Frame::middle_z_at(double y_m) const {
  const double last = static_cast<double>(middle_z_m.size() - 1);
  const double place = std::clamp(height(y_m) * last, 0.0, last);
  const auto below = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  const double share = place - static_cast<double>(below);
  return (1 - share) * middle_z_m[below] + share * middle_z_m[below + 1];
}

double RegionPlan::Frame::angle_degrees(const glm::dvec3& position_m) const {
  return std::atan2(position_m.x - middle_x_m, position_m.z - middle_z_at(position_m.y)) * 180 / std::numbers::pi;
}

RegionPlan::RegionPlan(const Body& body, const std::vector<RegionSpec>& regions, std::string_view name)
    : body_(body), step_(affordable_step(body.surface(), kMostSamples, [&](std::uint32_t triangle, double step) {
        return sampled(body.surface(), triangle, step);
      })) {
  for (const RegionSpec& spec : regions) {
    const std::string where = fmt::format("{}, region '{}'", name, spec.name);
    if (needs_standing(spec, body.understanding())) require_standing(body.avatar().facing, where);
    Region region;
    choose_skin(spec, where, region);
    region.columns = column_angles(spec, where);
    number_actuators(spec, where, region);
    if (!fit_frame(region)) continue;  // its actuators have no skin, and the map maker decides what to do about that
    const Frame& frame = region.frame;
    region.rows_m = {frame.low_m, frame.high_m};
    if (spec.height_m) region.rows_m = *spec.height_m;
    if (spec.height) {
      const double size_m = frame.high_m - frame.low_m;
      region.rows_m = {frame.low_m + spec.height->low * size_m, frame.low_m + spec.height->high * size_m};
      // The lowest and the highest point belong to intervals that reach 0 and 1.
      if (spec.height->low <= 0) region.rows_m.low = -std::numeric_limits<double>::infinity();
      if (spec.height->high >= 1) region.rows_m.high = std::numeric_limits<double>::infinity();
    }
    if (spec.height || spec.height_m) region.height_m = region.rows_m;
    region.rows_m = {std::max(region.rows_m.low, frame.low_m), std::min(region.rows_m.high, frame.high_m)};
    for (const std::string& side : spec.sides) region.angles.push_back(angles_of(side));
    if (spec.angle_degrees) region.angles.push_back(*spec.angle_degrees);
    if (spec.grid) {
      region.row_count = spec.grid->rows;
      region.column_count = spec.grid->columns;
    } else if (!spec.actuators.empty()) {
      place_sites(spec, where, region);
      region.radius_m = spec.radius_m.value_or(std::numeric_limits<double>::infinity());
      for (std::size_t i = 0; i < region.sites.size(); ++i)
        given_position_m_[region.actuators[i] - 1U] = region.sites[i].position_m;
    }
    regions_.push_back(std::move(region));
  }
}

void RegionPlan::number_actuators(const RegionSpec& spec, const std::string& where, Region& region) {
  if (spec.grid) {
    const std::size_t columns = spec.grid->columns;
    for (std::size_t i = 0; i < spec.grid->rows * columns; ++i)
      region.actuators.push_back(number_of(spec.grid->names.empty()
                                               ? fmt::format("{} {}-{}", spec.name, i / columns + 1, i % columns + 1)
                                               : spec.grid->names[i]));
    return;
  }
  std::set<std::string_view> seen;
  for (const RegionActuator& actuator : spec.actuators) {
    if (!seen.insert(actuator.name).second)
      throw Error(where, fmt::format("two of its actuators have the name '{}'", actuator.name),
                  "give each a different name");
    region.actuators.push_back(number_of(actuator.name));
  }
  if (spec.actuators.empty()) region.actuators.push_back(number_of(spec.name));
}

std::uint16_t RegionPlan::number_of(const std::string& actuator_name) {
  const auto found = std::ranges::find(names_, actuator_name);
  const auto number = static_cast<std::uint16_t>(found - names_.begin() + 1);
  if (found == names_.end()) {
    if (names_.size() == 65534)
      throw Error(actuator_name, "is actuator number 65535, but a map has at most 65534", "use fewer actuators");
    names_.push_back(actuator_name);
    given_position_m_.emplace_back();
  }
  return number;
}

template <typename Visit>
void RegionPlan::for_each_sample(const Visit& visit) const {
  for (std::uint32_t i = 0; i < body_.avatar().triangles.size(); ++i)
    sampled(body_.surface(), i, step_).for_each([&](const SkinPoint& point) { visit(ask(point)); });
}

RegionPlan::PartChoice RegionPlan::part_choice(const std::string& text, const std::string& where) const {
  PartChoice choice;
  std::string_view word = text;
  if (word.ends_with(" left")) choice.half = Half::kLeft;
  if (word.ends_with(" right")) choice.half = Half::kRight;
  if (choice.half != Half::kBoth) word = word.substr(0, word.rfind(' '));
  choice.vest = word == "vest";
  const auto part = choice.vest ? SkinPart::kTorso : skin_part_named(word);
  if (part) {
    choice.part = *part;
    return choice;
  }
  std::vector<std::string> known = {"vest"};
  for (std::size_t i = 0; i < kSkinParts; ++i) known.emplace_back(to_string(static_cast<SkinPart>(i)));
  throw UnknownName(where, "part", text, known);
}

void RegionPlan::choose_skin(const RegionSpec& spec, const std::string& where, Region& region) const {
  for (const std::string& part : spec.parts) region.parts.push_back(part_choice(part, where));
  if (spec.joints.empty() && spec.below.empty()) return;
  const Avatar& avatar = body_.avatar();
  std::set<std::string> known;
  for (const PaletteEntry& entry : avatar.palette)
    known.insert(avatar.nodes[static_cast<std::size_t>(entry.node)].name);
  const auto matching = [&](const std::string& pattern) {
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < avatar.nodes.size(); ++i)
      if (matches(pattern, avatar.nodes[i].name)) nodes.push_back(i);
    if (nodes.empty()) throw UnknownName(where, "joint", pattern, {known.begin(), known.end()});
    return nodes;
  };
  region.nodes.assign(avatar.nodes.size(), false);
  for (const std::string& pattern : spec.below)
    for (const std::size_t node : matching(pattern)) region.nodes[node] = true;
  for (const int node : avatar.node_order) {
    const int parent = avatar.nodes[static_cast<std::size_t>(node)].parent;
    if (parent >= 0 && region.nodes[static_cast<std::size_t>(parent)])
      region.nodes[static_cast<std::size_t>(node)] = true;
  }
  for (const std::string& pattern : spec.joints)
    for (const std::size_t node : matching(pattern)) region.nodes[node] = true;
}

RegionPlan::Asked RegionPlan::ask(const SkinPoint& point) const {
  return {point, body_.turned(body_.surface().position_m(point)), body_.part_at(point)};
}

bool RegionPlan::selects(const Region& region, const Asked& asked) const {
  if (!region.nodes.empty() && !region.nodes[static_cast<std::size_t>(body_.node_at(asked.point))]) return false;
  if (region.parts.empty()) return true;
  const glm::dvec3& p = asked.position_m;
  return std::ranges::any_of(region.parts, [&](const PartChoice& choice) {
    if (choice.part != asked.part) return false;
    if (choice.half != Half::kBoth && (choice.half == Half::kLeft) != (p.x >= body_.middle_x_m())) return false;
    return !choice.vest || (p.y >= body_.vest_low_m() && p.y < body_.vest_high_m());
  });
}

bool RegionPlan::fit_frame(Region& region) const {
  Frame& frame = region.frame;
  frame.low_m = std::numeric_limits<double>::infinity();
  frame.high_m = -frame.low_m;
  double low_x = frame.low_m;
  double high_x = frame.high_m;
  std::vector<glm::dvec3> samples;
  for_each_sample([&](const Asked& asked) {
    if (!selects(region, asked)) return;
    const glm::dvec3& p = asked.position_m;
    samples.push_back(p);
    frame.low_m = std::min(frame.low_m, p.y);
    frame.high_m = std::max(frame.high_m, p.y);
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
  });
  if (samples.empty()) return false;
  if (!(frame.low_m < frame.high_m)) frame.high_m = frame.low_m + 1e-6;
  // A vest's skin ends exactly at the cut. Samples only come near to the cut.
  if (!region.parts.empty() && std::ranges::all_of(region.parts, &PartChoice::vest))
    if (frame.low_m - body_.vest_low_m() < 0.02 * body_.surface().height_m() &&
        body_.vest_high_m() - frame.high_m < 0.02 * body_.surface().height_m()) {
      frame.low_m = body_.vest_low_m();
      frame.high_m = body_.vest_high_m();
    }
  const double middle_m = body_.middle_x_m();
  frame.middle_x_m = low_x < middle_m && high_x > middle_m ? middle_m : (low_x + high_x) / 2;
  // The middle between the foremost and the hindmost skin at every height. Without skin at a height, the middle of the
  // height below is used.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<std::array<double, 2>> ends(kAxisPoints, {kNone, -kNone});
  for (const glm::dvec3& p : samples) {
    auto& [low_z, high_z] = ends[piece(p.y, {frame.low_m, frame.high_m}, kAxisPoints)];
    low_z = std::min(low_z, p.z);
    high_z = std::max(high_z, p.z);
  }
  frame.middle_z_m.clear();
  for (const auto& [low_z, high_z] : ends)
    frame.middle_z_m.push_back(low_z <= high_z            ? (low_z + high_z) / 2
                               : frame.middle_z_m.empty() ? 0
                                                          : frame.middle_z_m.back());
  const std::vector<double> rough = frame.middle_z_m;
  for (std::size_t i = 1; i + 1 < rough.size(); ++i)
    frame.middle_z_m[i] = rough[i - 1] / 4 + rough[i] / 2 + rough[i + 1] / 4;
  return true;
}

bool RegionPlan::holds(const Region& region, const Asked& asked) const {
  const glm::dvec3& p = asked.position_m;
  if (region.height_m && !(p.y >= region.height_m->low && p.y < region.height_m->high)) return false;
  if (!selects(region, asked)) return false;
  if (region.angles.empty()) return true;
  const double degrees = region.frame.angle_degrees(p);
  return std::ranges::all_of(region.angles, [&](const Extent& angles) { return is_within(degrees, angles); });
}

void RegionPlan::place_sites(const RegionSpec& spec, const std::string& where, Region& region) const {
  struct Nearest {
    SkinPoint point;
    double distance_squared = std::numeric_limits<double>::infinity();
  };
  std::vector<Nearest> nearest(spec.actuators.size());
  const Frame& frame = region.frame;
  for_each_sample([&](const Asked& asked) {
    if (!holds(region, asked)) return;
    const glm::dvec3& p = asked.position_m;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const RegionActuator& wanted = spec.actuators[i];
      double distance_squared = 0;
      if (wanted.position_m) {
        const glm::dvec3 off = p - body_.turned(*wanted.position_m);
        distance_squared = glm::dot(off, off);
      } else {
        const double up_m = (frame.height(p.y) - wanted.height) * (frame.high_m - frame.low_m);
        const double off = frame.angle_degrees(p) - wanted.angle_degrees;
        const double radius_m = std::hypot(p.x - frame.middle_x_m, p.z - frame.middle_z_at(p.y));
        const double around_m = (off - 360 * std::round(off / 360)) * std::numbers::pi / 180 * radius_m;
        distance_squared = up_m * up_m + around_m * around_m;
      }
      if (distance_squared < nearest[i].distance_squared) nearest[i] = {asked.point, distance_squared};
    }
  });
  const Avatar& avatar = body_.avatar();
  const SurfaceDistance distance(body_.surface().rest_m(), avatar.triangles, SurfaceDistance::Gaps::kBridged);
  for (const Nearest& place : nearest) {
    if (std::isinf(place.distance_squared))
      throw Error(where, "selects no skin for its actuators", "check its height, angle and side");
    Site site;
    site.position_m = body_.surface().position_m(place.point);
    site.detour_m = distance.from(place.point);
    for (std::size_t i = 0; i < site.detour_m.size(); ++i)
      site.detour_m[i] -= glm::distance(body_.surface().rest_m()[i], site.position_m);
    region.sites.push_back(std::move(site));
  }
}

std::uint16_t RegionPlan::actuator_within(const Region& region, const Asked& asked) const {
  const SkinPoint& point = asked.point;
  const glm::dvec3& position_m = asked.position_m;
  if (region.sites.empty()) {
    if (region.actuators.size() == 1) return region.actuators.front();
    const std::size_t from_below = piece(position_m.y, region.rows_m, region.row_count);
    const std::size_t row = region.row_count - 1 - from_below;
    const double beyond = region.frame.angle_degrees(position_m) - region.columns.low;
    const double degrees = region.columns.low + beyond - 360 * std::floor(beyond / 360);
    return region.actuators[row * region.column_count + piece(degrees, region.columns, region.column_count)];
  }
  const glm::uvec3& corner = body_.avatar().triangles[point.triangle];
  const glm::dvec3 place_m = turned_from_front(position_m, body_.avatar().facing.axis);
  std::size_t best = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < region.sites.size(); ++i) {
    const Site& site = region.sites[i];
    const double detour_m = point.weight.x * site.detour_m[corner.x] + point.weight.y * site.detour_m[corner.y] +
                            point.weight.z * site.detour_m[corner.z];
    const double distance_m = glm::distance(place_m, site.position_m) + detour_m;
    if (distance_m < least_m) {
      least_m = distance_m;
      best = i;
    }
  }
  return least_m <= region.radius_m ? region.actuators[best] : std::uint16_t{0};
}

std::uint16_t RegionPlan::at(const SkinPoint& point) const {
  const Asked asked = ask(point);
  for (const Region& region : regions_)
    if (holds(region, asked))
      if (const std::uint16_t actuator = actuator_within(region, asked)) return actuator;
  return 0;
}

}  // namespace vestige
