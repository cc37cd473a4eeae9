#include "detector/actuators/posed_places.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace vestige {

PosedPlaces::PosedPlaces(const Avatar& avatar, std::span<const std::optional<SkinPoint>> places)
    : weights_(places.size()), now_(places.size()) {
  corners_.influence_count = avatar.influence_count;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SkinPoint point = places[i].value_or(SkinPoint());
    if (places[i]) weights_[i] = point.weight;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = avatar.triangles[point.triangle][k];
      corners_.position_bind.push_back(avatar.position_bind[vertex]);
      corners_.influences.push_back(avatar.influences[vertex]);
    }
  }
}

void PosedPlaces::move(std::span<const SkinMatrix> palette) {
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    if (!weights_[i]) continue;
    glm::dvec3 place(0);
    for (int k = 0; k < 3; ++k)
      place += (*weights_[i])[k] * glm::dvec3(skin_vertex(corners_, palette, 3 * i + static_cast<std::size_t>(k)));
    now_[i] = place;
  }
}

void PosedPlaces::covered_by(std::uint32_t column, const DetectorFrame& frame,
                             std::vector<CoveredPlace>& covered) const {
  const auto segment = std::ranges::lower_bound(frame.segments, column, {}, &Segment::column);
  const glm::dvec3 centre(segment->end);
  for (std::uint32_t i = 0; i < now_.size(); ++i) {
    if (!now_[i]) continue;
    const double depth_m = segment->radius_m - glm::distance(centre, *now_[i]);
    if (depth_m > 0) covered.push_back({i, depth_m});
  }
}

}  // namespace vestige
