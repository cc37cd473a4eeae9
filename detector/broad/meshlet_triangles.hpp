#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "detector/ways/cut_ways.hpp"

namespace vestige {

/// Bounds that surely contain each triangle of a meshlet within a frame: a box, and a slab along the triangle's normal.
/// A segment that misses one of the two surely misses the triangle, as the CPU computes it. All other pairs remain to
/// be decided.
class MeshletTriangles {
 public:
  using Numbers = std::array<float, kMeshletTriangles>;

  /// One entry for each triangle. The slabs are those at the frame's start, where a segment starts, and at its end.
  struct Bounds {
    alignas(64) std::array<Numbers, 3> low;
    std::array<Numbers, 3> high;
    std::array<Numbers, 3> normal;
    std::array<Numbers, 2> slab_low;
    std::array<Numbers, 2> slab_high;
  };

  /// `kStatic` does not read `before`.
  void bound(const MeshletCorners& now, const MeshletCorners& before, Method method);

  /// Bit i of meets[k] says whether triangle i may meet segment numbers[k]. Bits after the meshlet's last triangle
  /// have no meaning.
  void meet(const Ways& ways, std::span<const std::uint32_t> numbers, std::uint32_t* meets) const;

  const Bounds& bounds() const { return bounds_; }

 private:
  Bounds bounds_ = {};
};

/// A point, and triangles.
struct TriangleGap {
  const MeshletTriangles::Bounds* bounds = nullptr;
  glm::vec3 point;
  float gap_m = 0;  ///< at least how far the point is from the nearest of them at the frame's end; 0: nothing is known
};

/// Fills in `gap_m`.
void find_triangle_gaps(std::span<TriangleGap> gaps);

}  // namespace vestige
