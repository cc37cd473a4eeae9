#include "analysis/plot/studio/contact_density.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <unordered_map>

namespace vestige::plot {

namespace {

/// Where the density is computed.
struct SkinPlace {
  glm::dvec3 point = glm::dvec3(0);
  glm::dvec3 normal = glm::dvec3(0);
  double area = 0;
  double contacts = 0;
};

constexpr double kReach = 3;  // in sigmas: 99 % of a Gaussian on a plane
/// Of all triangles together: a triangle needs 30 000 where it is as large as the body.
constexpr double kMostPlaces = 4e6;

/// Places by the cube they lie in, as wide as the Gaussian reaches.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<SkinPlace>& places, double reach) : places_(places), reach_(reach) {
    for (std::size_t i = 0; i < places.size(); ++i) cubes_[key(cube(places[i].point))].push_back(i);
  }

  /// Calls `visit(index, weight)` for the places that a contact at `place` is felt at.
  template <typename Visit>
  void around(const SkinPlace& place, double sigma, const Visit& visit) const {
    const glm::dvec3 middle = cube(place.point);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cubes_.find(key(middle + glm::dvec3(x, y, z)));
          if (found == cubes_.end()) continue;
          for (const std::size_t index : found->second) {
            const SkinPlace& other = places_[index];
            const glm::dvec3 apart = other.point - place.point;
            const double squared = glm::dot(apart, apart);
            if (squared > reach_ * reach_ || glm::dot(other.normal, place.normal) <= 0) continue;
            visit(index, std::exp(-squared / (2 * sigma * sigma)));
          }
        }
  }

 private:
  glm::dvec3 cube(const glm::dvec3& point) const { return glm::floor(point / reach_); }
  static std::uint64_t key(const glm::dvec3& cube) {
    constexpr std::int64_t kBits = 21;
    constexpr std::int64_t kMask = (std::int64_t{1} << kBits) - 1;
    std::int64_t result = 0;
    for (int axis = 0; axis < 3; ++axis) result = (result << kBits) | (static_cast<std::int64_t>(cube[axis]) & kMask);
    return static_cast<std::uint64_t>(result);
  }

  const std::vector<SkinPlace>& places_;
  double reach_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cubes_;
};

}  // namespace

ContactDensity::ContactDensity(const Surface& surface, std::span<const RecordedContact> contacts, double sigma) {
  std::vector<SkinPlace> places;
  cuts_.reserve(surface.triangles.size());
  const double most_parts = std::ceil(std::sqrt(2 * kMostPlaces / static_cast<double>(surface.triangles.size())));
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const glm::dvec3 a = surface.point(t, 0, 0);
    const glm::dvec3 b = surface.point(t, 1, 0);
    const glm::dvec3 c = surface.point(t, 0, 1);
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double area = glm::length(glm::cross(b - a, c - a)) / 2;
    Cut cut;
    cut.first = places.size();
    if (std::isfinite(longest))
      cut.parts = static_cast<std::size_t>(std::clamp(std::ceil(2 * longest / sigma), 1.0, most_parts));
    cuts_.push_back(cut);
    const auto parts = static_cast<double>(cut.parts);
    for (std::size_t v = 0; v <= cut.parts; ++v)
      for (std::size_t u = 0; u + v <= cut.parts; ++u) {
        const double weight_u = static_cast<double>(u) / parts;
        const double weight_v = static_cast<double>(v) / parts;
        places.push_back({surface.point(t, weight_u, weight_v), surface.normal(t, weight_u, weight_v), 0, 0});
      }
    const double share = std::isfinite(area) ? area / (parts * parts) / 3 : 0;
    const auto add = [&](std::size_t u, std::size_t v) { places[cut.place(u, v)].area += share; };
    for (std::size_t v = 0; v < cut.parts; ++v)
      for (std::size_t u = 0; u + v < cut.parts; ++u) {
        add(u, v), add(u + 1, v), add(u, v + 1);
        if (u + v + 1 < cut.parts) add(u + 1, v), add(u + 1, v + 1), add(u, v + 1);
      }
  }
  for (const RecordedContact& contact : contacts) {
    const Spot spot = spot_at(contact.triangle, contact.barycentric.x, contact.barycentric.y);
    for (std::size_t k = 0; k < 3; ++k) places[spot.place[k]].contacts += spot.weight[k];
  }
  const Neighbourhood neighbourhood(places, kReach * sigma);
  density_.assign(places.size(), 0);
  for (const SkinPlace& place : places) {
    if (place.contacts == 0) continue;
    double sum = 0;
    neighbourhood.around(place, sigma, [&](std::size_t index, double weight) { sum += weight * places[index].area; });
    if (!(sum > 0)) continue;  // a triangle without area, alone
    neighbourhood.around(place, sigma,
                         [&](std::size_t index, double weight) { density_[index] += place.contacts * weight / sum; });
  }
}

ContactDensity::Spot ContactDensity::spot_at(std::uint32_t triangle, double u, double v) const {
  const Cut& cut = cuts_[triangle];
  const auto parts = static_cast<double>(cut.parts);
  const double kept_u = std::clamp(u, 0.0, 1.0);
  const double x = kept_u * parts;
  const double y = std::clamp(v, 0.0, 1.0 - kept_u) * parts;
  const auto column = std::min(static_cast<std::size_t>(x), cut.parts - 1);
  const auto row = std::min(static_cast<std::size_t>(y), cut.parts - 1 - column);
  const double along = x - static_cast<double>(column);
  const double across = y - static_cast<double>(row);
  const std::size_t right = cut.place(column + 1, row);
  const std::size_t above = cut.place(column, row + 1);
  if (along + across <= 1 || column + row + 2 > cut.parts)
    return {{cut.place(column, row), right, above}, {1 - along - across, along, across}};
  return {{cut.place(column + 1, row + 1), above, right}, {along + across - 1, 1 - along, 1 - across}};
}

double ContactDensity::at(std::uint32_t triangle, double u, double v) const {
  const Spot spot = spot_at(triangle, u, v);
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += spot.weight[k] * density_[spot.place[k]];
  return sum;
}

double ContactDensity::highest() const {
  return density_.empty() ? 0 : *std::ranges::max_element(density_);
}

}  // namespace vestige::plot
