#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"

namespace vestige {

/// What surely holds each triangle of a meshlet within a frame: a box, and along the triangle's normal a slab. What
/// misses one of them surely misses the triangle, as the CPU computes it; the rest has to be decided.
class MeshletTriangles {
 public:
  using Numbers = std::array<float, kMeshletTriangles>;

  /// One for each triangle; slabs at the frame's start, where a segment starts, and at its end.
  struct Bounds {
    alignas(64) std::array<Numbers, 3> low;
    std::array<Numbers, 3> high;
    std::array<Numbers, 3> normal;
    std::array<Numbers, 2> slab_low;
    std::array<Numbers, 2> slab_high;
  };

  /// `before` is not read for `kStatic`.
  void bound(const MeshletCorners& now, const MeshletCorners& before, Method method);

  /// Bit i of meets[k] says whether triangle i may meet segments[numbers[k]]. Places beyond the meshlet's last triangle
  /// mean nothing.
  void meet(std::span<const Segment> segments, std::span<const std::uint32_t> numbers, std::uint32_t* meets) const;

 private:
  Bounds bounds_ = {};
};

}  // namespace vestige
