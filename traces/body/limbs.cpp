#include "traces/body/limbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <span>

#include "traces/body/body_roles.hpp"
#include "traces/body/skin_parts.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/radius.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostSpheres = 8;  ///< of one limb

constexpr SkinPart kMiddleParts[] = {SkinPart::kHead, SkinPart::kNeck, SkinPart::kTorso};
constexpr SkinPart kPairedParts[] = {SkinPart::kHand,  SkinPart::kForearm, SkinPart::kUpperArm,
                                     SkinPart::kThigh, SkinPart::kShin,    SkinPart::kFoot};

std::string name_of(SkinPart part, BodySide side) {
  std::string name(to_string(part));
  std::ranges::replace(name, ' ', '_');
  if (side == BodySide::kNone) return name;
  return name + (side == BodySide::kLeft ? "_left" : "_right");
}

/// Returns the side that each node belongs to: its own, or that of the node above it.
std::vector<BodySide> sides_of_nodes(const Avatar& avatar) {
  const auto roles = body_roles(avatar);
  std::vector<BodySide> sides(avatar.nodes.size(), BodySide::kNone);
  for (const int number : avatar.node_order) {
    const auto i = static_cast<std::size_t>(number);
    const int parent = avatar.nodes[i].parent;
    if (roles[i])
      sides[i] = roles[i]->side;
    else if (parent >= 0)
      sides[i] = sides[static_cast<std::size_t>(parent)];
  }
  return sides;
}

/// A triangle of a limb's skin at rest.
struct SkinPatch {
  glm::dvec3 centre_m;
  double area_m2;
  std::size_t node;  ///< that carries most of it
  double along_m = 0;
};

/// Returns the node with the largest weight in a triangle.
std::size_t heaviest_node(const Avatar& avatar, const glm::uvec3& triangle) {
  std::map<std::size_t, float> weights;
  for (int corner = 0; corner < 3; ++corner) {
    const Influences& influences = avatar.influences[triangle[corner]];
    for (std::size_t k = 0; k < avatar.influence_count; ++k)
      weights[static_cast<std::size_t>(avatar.palette[influences.palette[k]].node)] += influences.weight[k];
  }
  return std::ranges::max_element(weights, {}, [](const auto& entry) { return entry.second; })->first;
}

template <typename Belongs>
std::vector<SkinPatch> patches_of(const Avatar& avatar, const Belongs& belongs) {
  const std::vector<glm::dvec3> skin_m = skin_at_rest(avatar);
  std::vector<SkinPatch> patches;
  for (const glm::uvec3& triangle : avatar.triangles) {
    const std::size_t node = heaviest_node(avatar, triangle);
    if (!belongs(node)) continue;
    const glm::dvec3& a = skin_m[triangle.x];
    const glm::dvec3& b = skin_m[triangle.y];
    const glm::dvec3& c = skin_m[triangle.z];
    const double area_m2 = glm::length(glm::cross(b - a, c - a)) / 2;
    if (area_m2 > 0) patches.push_back({(a + b + c) / 3.0, area_m2, node});
  }
  return patches;
}

glm::dvec3 middle_of(std::span<const SkinPatch> patches) {
  glm::dvec3 sum(0);
  double area_m2 = 0;
  for (const SkinPatch& patch : patches) {
    sum += patch.area_m2 * patch.centre_m;
    area_m2 += patch.area_m2;
  }
  return sum / area_m2;
}

/// Returns the direction along which patches extend most.
glm::dvec3 axis_of(std::span<const SkinPatch> patches, const glm::dvec3& middle_m) {
  glm::dmat3 spread(0);
  for (const SkinPatch& patch : patches) {
    const glm::dvec3 away = patch.centre_m - middle_m;
    spread += patch.area_m2 * glm::outerProduct(away, away);
  }
  const auto longest = [](const glm::dmat3& m) {
    const double squared[] = {glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])};
    return m[static_cast<int>(std::ranges::max_element(squared) - squared)];
  };
  constexpr int kSquarings = 8;  // the directions beside the longest fade as (their share)^256
  for (int i = 0; i < kSquarings; ++i) {
    const double length = glm::length(longest(spread));
    if (!(length > 0)) return {0, 1, 0};
    spread = (spread / length) * (spread / length);
  }
  return glm::normalize(longest(spread));
}

/// Returns a sphere in the middle of patches, as large as their mean distance from there.
LimbSphere sphere_of(std::span<const SkinPatch> patches, const std::vector<glm::dmat4>& world) {
  const glm::dvec3 middle_m = middle_of(patches);
  double sum = 0;
  double area_m2 = 0;
  std::map<std::size_t, double> areas;
  for (const SkinPatch& patch : patches) {
    sum += patch.area_m2 * glm::distance(patch.centre_m, middle_m);
    area_m2 += patch.area_m2;
    areas[patch.node] += patch.area_m2;
  }
  const std::size_t node = std::ranges::max_element(areas, {}, [](const auto& entry) { return entry.second; })->first;
  const double radius_m = std::clamp(sum / area_m2, 0.001, static_cast<double>(kLargestRadius_m));
  return {node, glm::dvec3(glm::inverse(world[node]) * glm::dvec4(middle_m, 1)), static_cast<float>(radius_m)};
}

}  // namespace

const std::vector<std::string>& limb_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SkinPart part : kPairedParts)
      for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) all.push_back(name_of(part, side));
    for (const SkinPart part : kMiddleParts) all.push_back(name_of(part, BodySide::kNone));
    return all;
  }();
  return names;
}

std::vector<LimbSphere> fit_limb(const Avatar& avatar, std::string_view limb) {
  const std::vector<std::optional<SkinPart>> parts = parts_of_nodes(avatar);
  const std::vector<BodySide> sides = sides_of_nodes(avatar);
  std::vector<SkinPatch> patches = patches_of(avatar, [&](std::size_t node) {
    if (!parts[node]) return false;
    const bool is_paired = std::ranges::find(kPairedParts, *parts[node]) != std::end(kPairedParts);
    return limb == name_of(*parts[node], is_paired ? sides[node] : BodySide::kNone);
  });
  if (patches.empty()) return {};
  const glm::dvec3 middle_m = middle_of(patches);
  const glm::dvec3 axis = axis_of(patches, middle_m);
  double squares = 0;  // of distances from the axis
  double area_m2 = 0;
  for (SkinPatch& patch : patches) {
    const glm::dvec3 away = patch.centre_m - middle_m;
    patch.along_m = glm::dot(away, axis);
    squares += patch.area_m2 * std::max(0.0, glm::dot(away, away) - patch.along_m * patch.along_m);
    area_m2 += patch.area_m2;
  }
  std::ranges::stable_sort(patches, {}, &SkinPatch::along_m);
  const double first_m = patches.front().along_m;
  const double length_m = patches.back().along_m - first_m;
  const double thickness_m = 2 * std::sqrt(squares / area_m2);
  const double pieces = thickness_m > 0 ? std::round(length_m / thickness_m) : 1;
  const auto count = static_cast<std::size_t>(std::clamp(pieces, 1.0, static_cast<double>(kMostSpheres)));
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  std::vector<LimbSphere> spheres;
  auto begin = patches.begin();
  for (std::size_t piece = 1; piece <= count; ++piece) {
    const double end_m = first_m + length_m * static_cast<double>(piece) / static_cast<double>(count);
    const auto end =
        piece == count ? patches.end() : std::ranges::upper_bound(begin, patches.end(), end_m, {}, &SkinPatch::along_m);
    if (begin != end) spheres.push_back(sphere_of({begin, end}, world));
    begin = end;
  }
  return spheres;
}

}  // namespace vestige
