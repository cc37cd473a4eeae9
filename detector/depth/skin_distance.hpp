#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "detector/broad/meet_boxes.hpp"
#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/depth/skin_neighbours.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Signed distances from points to the skin as it is in a frame (detector/CONTRACT.md, Spheres, depth).
///
/// The distance is that to the nearest triangle, in fp64. The sign is that of the side which the point sees: of the
/// nearest face; of the triangle on the nearest edge whose plane is farthest away; at a corner, of the edge there that
/// makes the smallest angle with the direction to the point. A plane that is farther away is seen less obliquely, so
/// the sign is right where several sheets of skin meet, and where a triangle is there twice. Beyond a triangle without
/// area, the next one is seen; a triangle that is flatter than fp32 can tell has none. Vertices at one place of the
/// posed skin count as one corner. (Baerentzen & Aanaes 2005 weigh the normals around a corner by their angles instead,
/// which counts a triangle that is there twice two times.)
class SkinDistance {
 public:
  /// Keeps a reference to the avatar, which has triangles.
  explicit SkinDistance(const Avatar& avatar);

  /// Sets the frame that `signed_m` refers to. The frame must live until the next call, and its palette is finite.
  void begin(const DetectorFrame& frame);

  /// Returns the distance in metres, negative behind the skin. It is positive at the border of an open skin. `point` is
  /// relative to the frame's origin.
  double signed_m(const glm::dvec3& point);

 private:
  /// A triangle, and the weights of its corners for the point of it that is nearest.
  struct Nearest {
    double squared_m2;
    std::uint32_t triangle;
    glm::dvec3 weights;
  };

  /// How a point lies to a triangle's plane.
  struct PlaneSide {
    bool has_plane = false;
    double height = 0;  ///< times the length of the normal; negative behind
    double squared_m2 = 0;
  };

  /// The vertices of a triangle or an edge, by the number that stands for each place of the bind pose.
  using Numbers = std::array<std::uint32_t, 3>;
  using Edge = std::array<std::uint32_t, 2>;

  Numbers numbers_of(std::uint32_t triangle) const;
  static PlaneSide side_of(const glm::dvec3& point, const Corners& triangle);
  Nearest nearest_to(const glm::dvec3& point);
  void look_into(std::size_t meshlet, const glm::dvec3& point, Nearest& best);
  const MeshletCorners& skinned(std::size_t meshlet);
  Corners corners_of(std::uint32_t triangle) const;
  bool is_behind(const glm::dvec3& point, const Nearest& nearest);
  bool is_behind_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to);
  bool look_at_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to, PlaneSide& farthest);
  bool is_behind_corner(const glm::dvec3& point, std::uint32_t corner);

  const Avatar& avatar_;
  SkinNeighbours neighbours_;
  Meshlets meshlets_;
  MeshletBounds bounds_;
  MeshletSkin skin_;
  const DetectorFrame* frame_ = nullptr;
  std::vector<SkinBox> boxes_;           ///< of the meshlets in this frame
  std::vector<MeshletCorners> skinned_;  ///< those that were looked into
  std::vector<std::uint32_t> slot_;      ///< of each meshlet in `skinned_`, from 1; 0: not there
  std::vector<std::size_t> looked_into_;
  // What a query looks at:
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> crossed_;   ///< triangles without area beyond which it looked
  std::vector<std::uint32_t> together_;  ///< vertices at one place of the posed skin
  std::vector<std::uint32_t> visited_;   ///< for each vertex, the last visit in which it came to `together_`
  std::uint32_t visit_ = 0;
};

}  // namespace vestige
