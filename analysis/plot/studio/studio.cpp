#include "analysis/plot/studio/studio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

namespace {

constexpr std::size_t kFineness = 3;
constexpr std::size_t kShares = kFineness * kFineness;
constexpr std::size_t kKeyLights = 2 * kShares;
constexpr std::size_t kSkyLights = 4 * kShares;
constexpr double kKeyShare = 0.66;
/// Light that comes from everywhere, shadow or not: without it, creases are black in print.
constexpr double kEverywhere = 0.16;
constexpr double kExposure = 1.28;
constexpr double kGroundShadow = 0.6;
/// Beyond the body, in heights of it: there its shadow has faded.
constexpr double kShadowReach = 0.22;
constexpr double kShadowEdge = 0.15;  ///< of a picture's width
constexpr std::size_t kShadowDots = 320;
constexpr double kGolden = 2.399963229728653;  // radians; spreads points evenly on a disc or a sphere

/// One direction from which light comes, and what is nearest to it.
struct Light {
  View view;
  double weight = 0;
  std::vector<float> depth;

  bool reaches(const glm::dvec3& point) const {
    const glm::dvec3 seen = view.camera.seen(point);
    const double x = (seen.x - view.left) / view.unit_per_dot;
    const double y = static_cast<double>(view.height) - (seen.y - view.bottom) / view.unit_per_dot;
    if (!(x >= 0 && y >= 0 && x < static_cast<double>(view.width) && y < static_cast<double>(view.height))) return true;
    return depth[static_cast<std::size_t>(y) * view.width + static_cast<std::size_t>(x)] <= seen.z;
  }
};

Camera looking_along(const glm::dvec3& toward) {
  Camera camera;
  camera.toward = glm::normalize(toward);
  const glm::dvec3 helper = std::abs(camera.toward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  camera.right = glm::normalize(glm::cross(helper, camera.toward));
  camera.up = glm::cross(camera.toward, camera.right);
  return camera;
}

Light make_light(const Surface& surface, const glm::dvec3& toward, double weight) {
  Light light;
  light.weight = weight;
  const glm::dvec3 middle = (surface.low + surface.high) / 2.0;
  const double reach = glm::length(surface.high - surface.low) / 2;
  light.view.camera = looking_along(toward);
  light.view.width = light.view.height = kShadowDots;
  light.view.unit_per_dot = 2 * reach / static_cast<double>(kShadowDots);
  const glm::dvec3 seen = light.view.camera.seen(middle);
  light.view.left = seen.x - reach;
  light.view.bottom = seen.y - reach;
  for (const Sample& sample : draw_surface(surface, light.view)) light.depth.push_back(sample.depth);
  return light;
}

std::vector<Light> make_lights(const Surface& surface, const Camera& camera) {
  const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), camera.toward));
  const glm::dvec3 front = glm::cross(side, glm::dvec3(0, 1, 0));
  std::vector<Light> lights;
  // A broad lamp, so that shadows have soft edges.
  const Camera key = looking_along(-0.75 * side + glm::dvec3(0, 0.8, 0) + 0.65 * front);
  for (std::size_t i = 0; i < kKeyLights; ++i) {
    const double reach = 0.22 * std::sqrt((static_cast<double>(i) + 0.5) / kKeyLights);
    const double turn = kGolden * static_cast<double>(i);
    lights.push_back(make_light(surface, key.toward + reach * (std::cos(turn) * key.right + std::sin(turn) * key.up),
                                kKeyShare / kKeyLights));
  }
  // A sky that reaches a little below the horizon and is brighter towards the viewer.
  double sum = 0;
  for (std::size_t i = 0; i < kSkyLights; ++i) {
    const double height = 1 - 1.35 * (static_cast<double>(i) + 0.5) / kSkyLights;
    const double turn = kGolden * static_cast<double>(i);
    const double reach = std::sqrt(1 - height * height);
    const glm::dvec3 toward = reach * std::cos(turn) * side + glm::dvec3(0, height, 0) + reach * std::sin(turn) * front;
    const double weight = 1 + 0.7 * glm::dot(toward, front);
    sum += weight;
    lights.push_back(make_light(surface, toward, weight));
  }
  for (std::size_t i = kKeyLights; i < lights.size(); ++i) lights[i].weight *= 2.0 * (1 - kKeyShare) / sum;
  return lights;
}

double linear_of(std::uint8_t channel) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double value = static_cast<double>(i) / 255;
      result[i] = static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    }
    return result;
  }();
  return double{table[channel]};
}

glm::dvec3 linear_of(Colour colour) {
  return {linear_of(colour.red), linear_of(colour.green), linear_of(colour.blue)};
}

View finer(View view) {
  view.width *= kFineness;
  view.height *= kFineness;
  view.unit_per_dot /= static_cast<double>(kFineness);
  return view;
}

}  // namespace

View view_of_cell(const Camera& camera, double width_pt, double height_pt, double unit_per_pt) {
  View view;
  view.camera = camera;
  view.width = print_dots(width_pt);
  view.height = print_dots(height_pt);
  view.unit_per_dot = unit_per_pt * width_pt / static_cast<double>(view.width);
  return view;
}

StudioShot::StudioShot(const Surface& surface, const View& view, std::optional<double> ground_y)
    : view_(view), fine_(finer(view)), samples_(draw_surface(surface, fine_)) {
  light(surface, ground_y);
}

glm::dvec2 StudioShot::dot_of(const glm::dvec3& point) const {
  const glm::dvec3 seen = view_.camera.seen(point);
  return {(seen.x - view_.left) / view_.unit_per_dot,
          static_cast<double>(view_.height) - (seen.y - view_.bottom) / view_.unit_per_dot};
}

const Sample& StudioShot::at(std::size_t column, std::size_t row) const {
  return samples_[(row * kFineness + kFineness / 2) * fine_.width + column * kFineness + kFineness / 2];
}

/// Each of the samples in a dot asks another share of the lights, so that a dot asks all of them.
void StudioShot::light(const Surface& surface, std::optional<double> ground_y) {
  const std::vector<Light> lights = make_lights(surface, view_.camera);
  const Camera& camera = view_.camera;
  const double offset = 1.5 * lights.front().view.unit_per_dot;
  light_.assign(samples_.size(), 1.0F);
  const glm::dvec3 middle = (surface.low + surface.high) / 2.0;
  const glm::dvec3 half = (surface.high - surface.low) / 2.0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const std::size_t row = i / fine_.width;
    const std::size_t column = i % fine_.width;
    const std::size_t dot = row / kFineness * view_.width + column / kFineness;
    const std::size_t share = (row % kFineness * kFineness + column % kFineness + dot * 5) % kShares;
    const Sample& sample = samples_[i];
    const bool is_ground = sample.triangle == Sample::kNothing;
    glm::dvec3 point(0);
    glm::dvec3 normal(0, 1, 0);
    double strength = 0;
    if (!is_ground) {
      point = surface.point(sample.triangle, double{sample.u}, double{sample.v});
      normal = surface.normal(sample.triangle, double{sample.u}, double{sample.v});
      if (glm::dot(normal, camera.toward) < 0) normal = -normal;  // an open surface from behind
    } else {
      if (!ground_y || camera.toward.y <= 0) continue;
      const double x = view_.left + (static_cast<double>(column) + 0.5) * fine_.unit_per_dot;
      const double y = view_.bottom + (static_cast<double>(fine_.height - row) - 0.5) * fine_.unit_per_dot;
      point = x * camera.right + y * camera.up;
      point += camera.toward * ((*ground_y - point.y) / camera.toward.y);
      const double beyond = std::hypot(std::max(0.0, std::abs(point.x - middle.x) - half.x),
                                       std::max(0.0, std::abs(point.z - middle.z) - half.z));
      strength = 1 - beyond / (kShadowReach * 2 * half.y);
      if (!(strength > 0)) continue;
      // Nothing is cut off at the picture's edges.
      const double aside = static_cast<double>(std::min(column, fine_.width - 1 - column));
      strength *= std::min(1.0, aside / (kShadowEdge * static_cast<double>(fine_.width)));
      strength *= kGroundShadow * strength * (3 - 2 * strength);
    }
    const glm::dvec3 raised = point + offset * normal;
    double reaching = 0;
    double possible = 0;
    for (std::size_t k = share; k < lights.size(); k += kShares) {
      const double cosine = glm::dot(lights[k].view.camera.toward, normal);
      if (cosine <= 0) continue;
      possible += lights[k].weight * cosine;
      if (lights[k].reaches(raised)) reaching += lights[k].weight * cosine;
    }
    if (is_ground)
      light_[i] = static_cast<float>(possible > 0 ? 1 - strength * (1 - reaching / possible) : 1);
    else
      light_[i] = static_cast<float>(kExposure * (kEverywhere + (1 - kEverywhere) * reaching * kShares));
  }
}

StudioShot::Overlay::Overlay(const StudioShot& shot, Colour colour) : shot_(shot), colour_(colour) {}

void StudioShot::Overlay::line(const End& from, const End& to, double width_dots, double hidden, double tolerance) {
  const View& fine = shot_.fine_;
  const auto placed = [&](const glm::dvec3& point) {
    const glm::dvec3 seen = fine.camera.seen(point);
    return glm::dvec3((seen.x - fine.left) / fine.unit_per_dot,
                      static_cast<double>(fine.height) - (seen.y - fine.bottom) / fine.unit_per_dot, seen.z);
  };
  const glm::dvec3 a = placed(from.point);
  const glm::dvec3 b = placed(to.point);
  const double radius = width_dots * static_cast<double>(kFineness) / 2;
  const auto last = [](std::size_t count) { return static_cast<double>(count) - 1; };
  const double left = std::max(0.0, std::floor(std::min(a.x, b.x) - radius));
  const double right = std::min(last(fine.width), std::ceil(std::max(a.x, b.x) + radius));
  const double top = std::max(0.0, std::floor(std::min(a.y, b.y) - radius));
  const double bottom = std::min(last(fine.height), std::ceil(std::max(a.y, b.y) + radius));
  if (!(left <= right && top <= bottom)) return;
  if (opacity_.empty()) opacity_.assign(shot_.samples_.size(), 0.0F);
  const glm::dvec2 along(b.x - a.x, b.y - a.y);
  const double squared = glm::dot(along, along);
  for (auto row = static_cast<std::size_t>(top); row <= static_cast<std::size_t>(bottom); ++row) {
    for (auto column = static_cast<std::size_t>(left); column <= static_cast<std::size_t>(right); ++column) {
      const glm::dvec2 here(static_cast<double>(column) + 0.5 - a.x, static_cast<double>(row) + 0.5 - a.y);
      const double part = squared > 0 ? std::clamp(glm::dot(here, along) / squared, 0.0, 1.0) : 0.0;
      const glm::dvec2 beside = here - part * along;
      if (glm::dot(beside, beside) > radius * radius) continue;
      const std::size_t i = row * fine.width + column;
      const double depth = std::lerp(a.z, b.z, part);
      double opacity = std::lerp(from.opacity, to.opacity, part);
      if (depth + tolerance < double{shot_.samples_[i].depth}) opacity *= hidden;
      opacity_[i] = std::max(opacity_[i], static_cast<float>(opacity));
    }
  }
}

void StudioShot::Overlay::dot(const glm::dvec3& centre, double width_dots, double opacity, double hidden,
                              double tolerance) {
  const View& view = shot_.view_;
  const glm::dvec2 at = shot_.dot_of(centre);
  if (at.x >= 0 && at.y >= 0 && at.x < static_cast<double>(view.width) && at.y < static_cast<double>(view.height)) {
    if (nearest_.empty()) nearest_.assign(view.width * view.height, -std::numeric_limits<float>::infinity());
    float& nearest = nearest_[static_cast<std::size_t>(at.y) * view.width + static_cast<std::size_t>(at.x)];
    const auto depth = static_cast<float>(view.camera.seen(centre).z);
    if (nearest >= depth) return;
    nearest = depth;
  }
  line({centre, opacity}, {centre, opacity}, width_dots, hidden, tolerance);
}

void StudioShot::Overlay::sphere(const glm::dvec3& centre, double radius, double opacity, double hidden) {
  constexpr double kMiddle = 0.3;  // of the opacity at the rim
  const View& fine = shot_.fine_;
  const glm::dvec3 seen = fine.camera.seen(centre);
  const auto column_of = [&](double x) { return (x - fine.left) / fine.unit_per_dot; };
  const auto row_of = [&](double y) {
    return static_cast<double>(fine.height) - (y - fine.bottom) / fine.unit_per_dot;
  };
  const double left = std::max(0.0, std::floor(column_of(seen.x - radius)));
  const double right = std::min(static_cast<double>(fine.width) - 1, std::ceil(column_of(seen.x + radius)));
  const double top = std::max(0.0, std::floor(row_of(seen.y + radius)));
  const double bottom = std::min(static_cast<double>(fine.height) - 1, std::ceil(row_of(seen.y - radius)));
  if (!(left <= right && top <= bottom)) return;
  if (opacity_.empty()) opacity_.assign(shot_.samples_.size(), 0.0F);
  for (auto row = static_cast<std::size_t>(top); row <= static_cast<std::size_t>(bottom); ++row) {
    for (auto column = static_cast<std::size_t>(left); column <= static_cast<std::size_t>(right); ++column) {
      const double x = (static_cast<double>(column) + 0.5 - column_of(seen.x)) * fine.unit_per_dot / radius;
      const double y = (static_cast<double>(row) + 0.5 - row_of(seen.y)) * fine.unit_per_dot / radius;
      const double beside = x * x + y * y;
      if (beside > 1) continue;
      const double towards = std::sqrt(1 - beside);
      const std::size_t i = row * fine.width + column;
      double here = opacity * std::lerp(1.0, kMiddle, towards);
      if (seen.z + radius * towards < double{shot_.samples_[i].depth}) here *= hidden;
      opacity_[i] = std::max(opacity_[i], static_cast<float>(here));
    }
  }
}

Raster StudioShot::picture(const Paint& paint, const std::vector<Overlay>& overlays) const {
  Raster raster(view_.width, view_.height, kWhite);
  for (std::size_t row = 0; row < view_.height; ++row) {
    for (std::size_t column = 0; column < view_.width; ++column) {
      glm::dvec3 sum(0);
      for (std::size_t part = 0; part < kShares; ++part) {
        const std::size_t i =
            (row * kFineness + part / kFineness) * fine_.width + column * kFineness + part % kFineness;
        const Sample& sample = samples_[i];
        const Colour colour =
            sample.triangle == Sample::kNothing ? kWhite : paint(sample.triangle, double{sample.u}, double{sample.v});
        glm::dvec3 shown = linear_of(colour) * double{light_[i]};
        for (const Overlay& overlay : overlays)
          if (!overlay.opacity_.empty() && overlay.opacity_[i] > 0)
            shown += (linear_of(overlay.colour_) - shown) * double{overlay.opacity_[i]};
        sum += glm::min(shown, glm::dvec3(1));
      }
      sum /= static_cast<double>(kShares);
      raster.at(column, row) = {srgb_channel(sum.r), srgb_channel(sum.g), srgb_channel(sum.b)};
    }
  }
  return raster;
}

}  // namespace vestige::plot
