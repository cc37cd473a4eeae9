#include "traces/exchange/collider_mesh.hpp"

#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace vestige {

namespace {

using Json = gltf::GlbBuilder::Json;

struct Sphere {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<std::uint16_t> indices;
};

Sphere make_sphere(double radius_m) {
  constexpr int kRings = 8;
  constexpr int kSegments = 12;
  Sphere sphere;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int segment = 0; segment < kSegments; ++segment) {
      const double polar = glm::pi<double>() * ring / kRings;
      const double around = 2 * glm::pi<double>() * segment / kSegments;
      const glm::dvec3 normal(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
      for (int axis = 0; axis < 3; ++axis) {
        sphere.normals.push_back(static_cast<float>(normal[axis]));
        sphere.positions.push_back(static_cast<float>(radius_m * normal[axis]));
      }
    }
  const auto corner = [](int ring, int segment) {
    return static_cast<std::uint16_t>(ring * kSegments + segment % kSegments);
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int segment = 0; segment < kSegments; ++segment) {
      const std::uint16_t a = corner(ring, segment);
      const std::uint16_t b = corner(ring, segment + 1);
      const std::uint16_t c = corner(ring + 1, segment);
      const std::uint16_t d = corner(ring + 1, segment + 1);
      if (ring > 0) sphere.indices.insert(sphere.indices.end(), {a, b, c});
      if (ring + 1 < kRings) sphere.indices.insert(sphere.indices.end(), {b, d, c});
    }
  return sphere;
}

}  // namespace

int add_sphere(gltf::GlbBuilder& builder, double radius_m, int material) {
  const Sphere sphere = make_sphere(radius_m);
  const int position = builder.add_bounded_accessor(sphere.positions, "VEC3", 3, gltf::Target::kVertices);
  const int normal = builder.add_accessor(sphere.normals, "VEC3", 3, gltf::Target::kVertices);
  const int indices = builder.add_accessor(sphere.indices, "SCALAR", 1, gltf::Target::kIndices);
  return builder.add("meshes",
                     {{"name", "collider"},
                      {"primitives", Json::array({{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                                                   {"indices", indices},
                                                   {"material", material}}})}});
}

int add_collider_material(gltf::GlbBuilder& builder) {
  return builder.add("materials",
                     {{"name", "collider"},
                      {"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.3, 0.1, 1.0}}, {"metallicFactor", 0.0}}}});
}

}  // namespace vestige
