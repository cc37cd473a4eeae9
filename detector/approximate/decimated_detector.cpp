#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "detector/approximate/approximate_detectors.hpp"
#include "detector/approximate/skin_spots.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

/// A triangle is cut into kCellsAcross^2 equal cells, in rows that are parallel to its first edge.
constexpr std::size_t kCellsAcross = 4;

std::size_t cell_along(double share) {
  return std::min(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * kCellsAcross), kCellsAcross - 1);
}

/// Returns the cell of a point, given the weights of a triangle's second and third corner. Where rows and columns cut
/// out a parallelogram, the two triangles in it are two cells.
std::size_t cell_of(const glm::dvec2& weight) {
  const std::size_t column = cell_along(weight.x);
  // On the third edge, a point may lie at the corner of cells: then it belongs to the one inside.
  const std::size_t row = std::min(cell_along(weight.y), kCellsAcross - 1 - column);
  const double beyond =
      weight.x * kCellsAcross - static_cast<double>(column) + weight.y * kCellsAcross - static_cast<double>(row);
  return (row * kCellsAcross + column) * 2 + (beyond > 1 ? 1 : 0);
}

glm::dvec2 middle_of_cell(std::size_t cell) {
  const double within = cell % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
  const std::size_t column = cell / 2 % kCellsAcross;
  const std::size_t row = cell / 2 / kCellsAcross;
  return {(static_cast<double>(column) + within) / kCellsAcross, (static_cast<double>(row) + within) / kCellsAcross};
}

constexpr std::size_t kCells = 2 * kCellsAcross * kCellsAcross;

/// Whether a point of the triangle may fall into the cell: those farther out lie beyond its third edge.
bool is_reached(std::size_t cell) {
  return cell / 2 % kCellsAcross + cell / 2 / kCellsAcross < kCellsAcross;
}

Avatar simplified(const Avatar& avatar, const std::vector<glm::dvec3>& places, double keep) {
  const std::vector<glm::vec3> positions(places.begin(), places.end());
  std::vector<unsigned> indices;
  for (const glm::uvec3& triangle : avatar.triangles)
    indices.insert(indices.end(), {triangle.x, triangle.y, triangle.z});
  const auto target = static_cast<std::size_t>(std::ceil(keep * static_cast<double>(avatar.triangles.size()))) * 3;
  std::vector<unsigned> kept(indices.size());
  constexpr float kAnyError = 1e9F;
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), &positions.data()->x, positions.size(),
                               sizeof(glm::vec3), target, kAnyError, 0, nullptr));
  Avatar simple = avatar;
  simple.animations.clear();
  simple.triangles.clear();
  if (kept.empty()) kept.assign(indices.begin(), indices.begin() + 3);
  for (std::size_t i = 0; i < kept.size(); i += 3) simple.triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  return simple;
}

std::vector<RestPatch> patches_of(const Avatar& avatar, const std::vector<glm::dvec3>& places) {
  const Meshlets meshlets(avatar);
  std::vector<RestPatch> patches;
  for (std::size_t i = 0; i < meshlets.size(); ++i) {
    const auto triangles = meshlets.triangles(i);
    std::vector<Corners> corners;
    for (const std::uint32_t number : triangles) {
      const glm::uvec3& triangle = avatar.triangles[number];
      corners.push_back({places[triangle.x], places[triangle.y], places[triangle.z]});
    }
    patches.emplace_back(std::vector(triangles.begin(), triangles.end()), std::move(corners));
  }
  return patches;
}

class DecimatedDetector final : public Detector {
 public:
  DecimatedDetector(double keep, const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), surface_(options.surface) {
    const std::vector<glm::dvec3> places = skin_at_rest(avatar);
    simple_ = simplified(avatar, places, keep);
    const std::vector<RestPatch> patches = patches_of(avatar, places);
    spots_.resize(simple_.triangles.size() * kCells);
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      if (!is_reached(i % kCells)) continue;
      const glm::dvec2 weight = middle_of_cell(i % kCells);
      const glm::uvec3& corner = simple_.triangles[i / kCells];
      spots_[i] = nearest_spot(
          avatar, map, patches,
          (1 - weight.x - weight.y) * places[corner.x] + weight.x * places[corner.y] + weight.y * places[corner.z]);
    }
    detector_ = make_cpu_detector(simple_, no_map_, {Surface::kAll, PlaneSet::all(), options.method, options.skip});
  }

  const char* name() const override { return "decimated"; }
  Method method() const override { return detector_->method(); }
  std::uint64_t run_length() const override { return detector_->run_length(); }
  bool is_approximate() const override { return true; }
  std::optional<std::size_t> triangles_kept() const override { return simple_.triangles.size(); }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    const DetectorWork work = detector_->detect(frame, row);
    if (!frame.segments.empty()) enter(Stage::kDecision);
    for (Contact& contact : row) {
      if (!contact.hit()) continue;
      const SkinSpot& spot = spots_[contact.triangle * kCells + cell_of(contact.barycentric)];
      put_spot(spot, contact);
      if (surface_ == Surface::kMapped && spot.actuator == 0) contact = Contact();
    }
    return work;
  }

  void time_stages(StageClock* clock) override {
    Detector::time_stages(clock);
    detector_->time_stages(clock);
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  const Avatar& avatar_;
  Surface surface_;
  Avatar simple_;  ///< with all vertices
  ActuatorMap no_map_;
  std::vector<SkinSpot> spots_;  ///< kCells for each triangle of `simple_`
  std::unique_ptr<Detector> detector_;
};

}  // namespace

std::unique_ptr<Detector> make_decimated_detector(double keep, const Avatar& avatar, const ActuatorMap& map,
                                                  const DetectorOptions& options) {
  return std::make_unique<DecimatedDetector>(keep, avatar, map, options);
}

}  // namespace vestige
