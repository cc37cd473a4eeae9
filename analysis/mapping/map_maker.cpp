#include "analysis/mapping/map_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/base/png_image.hpp"
#include "analysis/mapping/skin_patches.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostInEightBits = 240;
constexpr double kMostPatchesOfBody = 1 << 20;

/// The skin of an actuator. Entry [0] is skin without an actuator.
struct SkinOfActuator {
  double area_m2 = 0;
  glm::dvec3 sum = glm::dvec3(0);  ///< of the positions, by area
  glm::dvec3 nearest_m = glm::dvec3(0);
  double distance_squared = std::numeric_limits<double>::infinity();
};

/// A body cut into patches.
class CutBody {
 public:
  explicit CutBody(const BodySurface& surface)
      : surface_(surface), step_(affordable_step(surface, kMostPatchesOfBody, [&](std::uint32_t triangle, double step) {
          return patches_of_body(surface, triangle, step);
        })) {}

  const BodySurface& surface() const { return surface_; }
  SkinPatches patches_of(std::uint32_t triangle) const { return patches_of_body(surface_, triangle, step_); }

  template <typename Visit>
  void for_each_patch(const WorkProgress& progress, const Visit& visit) const {
    for_each_triangle(surface_, progress, [&](std::uint32_t triangle) {
      const SkinPatches patches = patches_of(triangle);
      const double area_m2 = surface_.area_m2(triangle) / static_cast<double>(patches.count());
      patches.for_each([&](const SkinPoint& point) { visit(point, area_m2); });
    });
  }

 private:
  const BodySurface& surface_;
  double step_;
};

/// Returns the progress of the whole from that of its `part`-th part of `parts`, from 0.
WorkProgress part_of(const WorkProgress& progress, int part, int parts) {
  if (!progress) return {};
  return [progress, part, parts](double share) { progress((part + share) / parts); };
}

/// Share of the body's longest side. A region whose middle is this near to the body's middle has its actuator there.
constexpr double kCentral = 0.01;

/// Returns for each triangle the actuator that has most of it; the first one if several have the same share. But each
/// actuator with skin gets at least one triangle: the one of which it has most area.
std::vector<std::uint16_t> actuator_of_triangle(const CutBody& body, const ActuatorAt& actuator_at,
                                                std::size_t actuator_count, const WorkProgress& progress) {
  struct Most {
    double area_m2 = 0;
    std::uint32_t triangle = 0;
  };
  std::vector<Most> most_of(actuator_count + 1);
  std::vector<bool> has_one(actuator_count + 1, false);
  std::vector<std::uint16_t> actuators;
  actuators.reserve(body.surface().avatar().triangles.size());
  for_each_triangle(body.surface(), progress, [&](std::uint32_t i) {
    const SkinPatches patches = body.patches_of(i);
    std::map<std::uint16_t, std::size_t> count_of;
    patches.for_each([&](const SkinPoint& point) { ++count_of[actuator_at(point)]; });
    for (const auto& [actuator, count] : count_of) {
      const double area_m2 =
          body.surface().area_m2(i) * static_cast<double>(count) / static_cast<double>(patches.count());
      if (area_m2 > most_of[actuator].area_m2) most_of[actuator] = {area_m2, i};
    }
    actuators.push_back(std::ranges::max_element(count_of, {}, [](const auto& of) { return of.second; })->first);
    has_one[actuators.back()] = true;
  });
  for (std::size_t actuator = 1; actuator <= actuator_count; ++actuator)
    if (!has_one[actuator] && most_of[actuator].area_m2 > 0)
      actuators[most_of[actuator].triangle] = static_cast<std::uint16_t>(actuator);
  return actuators;
}

/// Returns the share of skin that does not fire its own actuator, of all skin that should fire or does.
double misplaced_share(const CutBody& body, const MapRaster& raster, const ActuatorAt& actuator_at,
                       const WorkProgress& progress) {
  ActuatorMap map;
  map.width = map.height = raster.side;
  map.actuator = raster.actuator;
  double misplaced_m2 = 0;
  double all_m2 = 0;
  body.for_each_patch(progress, [&](const SkinPoint& point, double area_m2) {
    const std::uint16_t meant = actuator_at(point);
    const std::uint16_t found = map.at(body.surface().texture_coordinate(point));
    if (meant == 0 && found == 0) return;
    all_m2 += area_m2;
    if (meant != found) misplaced_m2 += area_m2;
  });
  return all_m2 > 0 ? misplaced_m2 / all_m2 : 0;
}

std::vector<SkinOfActuator> measure(const Body& body, const CutBody& cut, const ActuatorAt& actuator_at,
                                    std::size_t actuator_count, const WorkProgress& progress) {
  const BodySurface& surface = body.surface();
  const double central_m = kCentral * surface.bounds().longest_side();
  const auto is_central = [&](const glm::dvec3& place_m) { return std::abs(body.leftwards_m(place_m)) < central_m; };
  std::vector<SkinOfActuator> skin(actuator_count + 1);
  struct Patch {
    std::uint16_t actuator;
    glm::dvec3 position_m;
  };
  std::vector<Patch> patches;
  cut.for_each_patch(progress, [&](const SkinPoint& point, double area_m2) {
    const Patch& patch = patches.emplace_back(Patch{actuator_at(point), surface.position_m(point)});
    skin[patch.actuator].area_m2 += area_m2;
    skin[patch.actuator].sum += area_m2 * patch.position_m;
  });
  for (const Patch& patch : patches) {
    SkinOfActuator& of = skin[patch.actuator];
    if (!(of.area_m2 > 0)) continue;
    const glm::dvec3 middle_m = of.sum / of.area_m2;
    const glm::dvec3 off = patch.position_m - middle_m;
    double distance_squared = glm::dot(off, off);
    // All skin around a head is equally far from its middle. Skin on the body's own middle takes precedence.
    if (is_central(middle_m) && !is_central(patch.position_m))
      distance_squared += surface.height_m() * surface.height_m();
    if (distance_squared >= of.distance_squared) continue;
    of.distance_squared = distance_squared;
    of.nearest_m = patch.position_m;
  }
  return skin;
}

/// Rounds to a tenth of a millimetre, as a researcher would write it.
double rounded(double metres) {
  return std::round(metres * 1e4) / 1e4 + 0.0;
}

/// `by_triangle` tells whether the texels are the avatar's triangles.
/// `fires` is JSON, or empty.
std::string sidecar_of(const std::vector<MadeActuator>& actuators, const Avatar& avatar, bool by_triangle,
                       const std::string& fires) {
  std::string text = "{\n";
  if (by_triangle)
    text += fmt::format("  \"triangles\": {},\n  \"skin\": \"{}\",\n", avatar.triangles.size(), skin_digest(avatar));
  text += fmt::format("  \"facing\": \"{}\",\n", to_string(avatar.facing.axis));
  text += "  \"actuators\": [\n";
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const glm::dvec3& p = actuators[i].position_m;
    const nlohmann::ordered_json entry = {
        {"grey", actuators[i].grey}, {"name", actuators[i].name}, {"position_m", {p.x, p.y, p.z}}};
    text += fmt::format("    {}{}\n", entry.dump(), i + 1 < actuators.size() ? "," : "");
  }
  return text + (fires.empty() ? "  ]\n}\n" : fmt::format("  ],\n  \"fires\": {}\n}}\n", fires));
}

void check_fires(const std::string& fires, const std::vector<MadeActuator>& actuators, std::string_view name) {
  std::vector<std::string> names;
  names.reserve(actuators.size());
  for (const MadeActuator& actuator : actuators) names.push_back(actuator.name);
  Firing(nlohmann::json::parse(fires), names, std::string(name));
}

std::vector<std::byte> png_of(const MadeMap& map) {
  std::vector<std::uint16_t> grey(map.raster.actuator.size());
  std::ranges::transform(map.raster.actuator, grey.begin(), [&](std::uint16_t actuator) {
    return actuator == 0 ? std::uint16_t{0} : map.actuators[actuator - 1U].grey;
  });
  std::optional<PngText> text;
  if (map.triangle_count != 0) text = {std::string(kMapKeyword), std::string(kTriangleMap)};
  const std::uint32_t side = map.raster.side;
  if (map.actuators.size() > kMostInEightBits) return grey_png(grey, side, side, text);
  return grey_png(std::vector<std::uint8_t>(grey.begin(), grey.end()), side, side, text);
}

std::string name_of(const std::vector<MadeActuator>& actuators, std::uint16_t actuator) {
  return actuator == 0 ? "skin without an actuator" : fmt::format("'{}'", actuators[actuator - 1U].name);
}

void warn_of(const MapRaster& raster, std::string_view avatar_name, MadeMap& map) {
  std::size_t texels = 0;
  auto worst = raster.conflicts.end();
  for (auto pair = raster.conflicts.begin(); pair != raster.conflicts.end(); ++pair) {
    texels += pair->second;
    if (worst == raster.conflicts.end() || pair->second > worst->second) worst = pair;
  }
  if (texels > 0)
    map.warnings.push_back(
        fmt::format("{}: its texture coordinates give {} texels to two places of the skin that should fire different "
                    "actuators, {} of them to {} and {}; both places fire the first. Make the map --per-triangle, or "
                    "give each its own place in the texture.",
                    avatar_name, texels, worst->second, name_of(map.actuators, worst->first.first),
                    name_of(map.actuators, worst->first.second)));
  if (raster.triangles_left_out > 0)
    map.warnings.push_back(
        fmt::format("{}: {} triangles are not mapped: their texture coordinates are not finite, or cover the texture "
                    "more than once.",
                    avatar_name, raster.triangles_left_out));
}

}  // namespace

MadeMap make_map(const Body& body, const RegionPlan& plan, const MapSettings& settings, std::string_view name,
                 std::string_view avatar_name) {
  if (!settings.per_triangle) require_texture_coordinates(body.avatar(), avatar_name);
  ActuatorAt actuator_at = [&](const SkinPoint& point) { return plan.at(point); };
  const CutBody cut(body.surface());
  const int parts = settings.per_triangle ? 2 : 3;
  std::vector<std::uint16_t> of_triangle;
  if (settings.per_triangle) {
    of_triangle = actuator_of_triangle(cut, actuator_at, plan.actuator_count(), part_of(settings.progress, 0, parts));
    actuator_at = [&](const SkinPoint& point) { return of_triangle[point.triangle]; };
  }
  const std::vector<SkinOfActuator> skin = measure(body, cut, actuator_at, plan.actuator_count(),
                                                   part_of(settings.progress, settings.per_triangle ? 1 : 0, parts));
  MadeMap map;
  std::vector<std::uint16_t> number(plan.actuator_count() + 1, 0);
  for (std::size_t i = 0; i < plan.actuator_count(); ++i) {
    if (skin[i + 1].area_m2 > 0) {
      MadeActuator& made = map.actuators.emplace_back();
      made.name = plan.names()[i];
      made.area_m2 = skin[i + 1].area_m2;
      const glm::dvec3 p = plan.given_position_m(i).value_or(skin[i + 1].nearest_m);
      made.position_m = {rounded(p.x), rounded(p.y), rounded(p.z)};
      number[i + 1] = static_cast<std::uint16_t>(map.actuators.size());
    } else if (settings.empty == EmptyRegions::kLeaveOut) {
      map.left_out.push_back(plan.names()[i]);
    } else {
      throw Error(fmt::format("{}, actuator '{}'", name, plan.names()[i]), "no skin belongs to it",
                  "widen its region, or move it before the regions that take its skin");
    }
  }
  if (map.actuators.empty())
    throw Error(name, "no skin of this avatar belongs to any of its regions", "use other regions");
  const std::size_t count = map.actuators.size();
  const std::size_t step = count <= kMostInEightBits ? kMostInEightBits / count : 65535 / count;
  for (std::size_t i = 0; i < count; ++i) map.actuators[i].grey = static_cast<std::uint16_t>(step * (i + 1));
  if (settings.per_triangle) {
    map.raster.side = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(of_triangle.size()))));
    std::ranges::transform(of_triangle, of_triangle.begin(), [&](std::uint16_t actuator) { return number[actuator]; });
    map.raster.actuator = of_triangle;
    map.raster.actuator.resize(std::size_t{map.raster.side} * map.raster.side, 0);
    map.triangle_count = of_triangle.size();
  } else {
    const ActuatorAt numbered = [&](const SkinPoint& point) { return number[plan.at(point)]; };
    map.raster =
        rasterise(body.surface(), numbered, settings.side, settings.padding, part_of(settings.progress, 1, parts));
    map.misplaced_share = misplaced_share(cut, map.raster, numbered, part_of(settings.progress, 2, parts));
  }
  map.files = {png_of(map), sidecar_of(map.actuators, body.avatar(), map.triangle_count != 0, settings.fires)};
  if (!settings.fires.empty()) check_fires(settings.fires, map.actuators, name);
  warn_of(map.raster, avatar_name, map);
  return map;
}

}  // namespace vestige
