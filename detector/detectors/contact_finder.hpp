#pragma once

#include <cstdint>

#include "detector/actuator_map.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/sphere_finder.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The narrow phase that `cpu` and `geometry` share: decides pairs of collider and triangle exactly, and keeps the
/// winner of each collider (detector/CONTRACT.md, 4 to 9). The order of the pairs does not matter.
class ContactFinder {
 public:
  ContactFinder(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar),
        map_(map),
        surface_(options.surface),
        method_(options.method),
        spheres_(avatar, map, options) {}

  /// Decides a pair, given the triangle's corners. `winner` is the best contact of this segment so far; a better
  /// contact replaces it. That of a sphere is known after `finish`.
  void offer(const DetectorFrame& frame, const MovingCorners& corners, const Segment& segment, std::uint32_t triangle,
             Contact& winner);

  /// The same for the triangles of a meshlet whose bits are set. The winner stands in the segment's column of `row`.
  void offer(const DetectorFrame& frame, const MeshletPlaces& meshlet, const Segment& segment, std::uint32_t bits,
             ContactRow& row);

  /// Completes a frame, after all its pairs were offered: writes the contacts of spheres, and counts pairs.
  void finish(const DetectorFrame& frame, ContactRow& row, DetectorWork& work);

 private:
  const Avatar& avatar_;
  const ActuatorMap& map_;
  Surface surface_;
  Method method_;
  SphereFinder spheres_;
  std::uint64_t meeting_ = 0;  ///< offered pairs that really meet
  std::uint64_t unsure_ = 0;   ///< pairs that needed exact arithmetic
};

}  // namespace vestige
