#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "detector/detector.hpp"
#include "detector/segment_triangle.hpp"

namespace vestige {

namespace {

class CpuDetector final : public Detector {
 public:
  CpuDetector(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), map_(map), surface_(options.surface) {}

  const char* name() const override { return "cpu"; }

  DetectorWork detect(const Frame& frame, ContactRow& row) override {
    row.assign(frame.columns, Contact());
    if (frame.segments.empty()) return {};
    skin_vertices(avatar_, frame.palette, vertices_);
    for (const Segment& segment : frame.segments) row[segment.column] = first_contact(frame, segment);
    return {frame.segments.size() * avatar_.triangles.size(), avatar_.triangles.size()};
  }

  void skinned_vertices(const Frame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  Contact first_contact(const Frame& frame, const Segment& segment) const {
    const glm::dvec3 p(segment.start);
    const glm::dvec3 q(segment.end);
    Contact best;
    for (std::uint32_t i = 0; i < avatar_.triangles.size(); ++i) {
      const glm::uvec3& corner = avatar_.triangles[i];
      const glm::dvec3 a(vertices_[corner.x]);
      const glm::dvec3 b(vertices_[corner.y]);
      const glm::dvec3 c(vertices_[corner.z]);
      const auto hit = segment_triangle(p, q, a, b, c);
      if (!hit) continue;
      // Ties after rounding go to the smallest triangle number: an equal t never replaces. +0 turns -0 into 0.
      const float t = static_cast<float>(hit->t) + 0.0F;
      if (!(t < best.t)) continue;
      Contact contact = describe(frame, segment, i, t);
      if (surface_ == Surface::kMapped && contact.actuator == 0) continue;
      contact.side = static_cast<std::int8_t>(hit->side);
      best = contact;
    }
    return best;
  }

  /// Everything about a contact that follows from the pair and t: contract, 7 and 8.
  Contact describe(const Frame& frame, const Segment& segment, std::uint32_t triangle, float t) const {
    const glm::uvec3& corner = avatar_.triangles[triangle];
    const glm::dvec3 a(vertices_[corner.x]);
    const glm::dvec3 b(vertices_[corner.y]);
    const glm::dvec3 c(vertices_[corner.z]);
    const glm::dvec3 p(segment.start);
    const glm::dvec3 way = glm::dvec3(segment.end) - p;
    Contact contact;
    contact.triangle = triangle;
    contact.t = t;
    contact.position = p + static_cast<double>(t) * way;
    contact.barycentric = barycentric_of(contact.position, a, b, c);
    const glm::dvec2 uv_a(avatar_.texture_coordinate[corner.x]);
    const glm::dvec2 uv_b(avatar_.texture_coordinate[corner.y]);
    const glm::dvec2 uv_c(avatar_.texture_coordinate[corner.z]);
    contact.texture_coordinate = uv_a + contact.barycentric.x * (uv_b - uv_a) + contact.barycentric.y * (uv_c - uv_a);
    contact.actuator = map_.at(contact.texture_coordinate);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (frame.duration_s > 0 && length > 0)
      contact.speed_m_per_s = std::abs(glm::dot(way, normal)) / length / frame.duration_s;
    return contact;
  }

  const Avatar& avatar_;
  const ActuatorMap& map_;
  Surface surface_;
  std::vector<glm::vec3> vertices_;
};

}  // namespace

std::unique_ptr<Detector> make_cpu_detector(const Avatar& avatar, const ActuatorMap& map,
                                            const DetectorOptions& options) {
  return std::make_unique<CpuDetector>(avatar, map, options);
}

}  // namespace vestige
