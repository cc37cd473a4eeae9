#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/broad/start_bounds.hpp"
#include "detector/contact.hpp"
#include "detector/decide/start_distance.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/contact_description.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// What the decisions of a frame took.
struct SphereCounts {
  std::uint64_t meeting = 0;  ///< pairs that touch, of those that had to be decided
  std::uint64_t unsure = 0;   ///< pairs, and choices between two, that needed exact arithmetic
};

/// The triangles of a meshlet, in the places that `before` and `now` have. They are the same with `kStatic`.
struct MeshletPlaces {
  const MeshletCorners& before;
  const MeshletCorners& now;
  std::span<const std::uint32_t> triangles;

  MovingCorners at(std::size_t i) const { return {before.corners(i), now.corners(i)}; }
};

/// The narrow phase for spheres (detector/CONTRACT.md, Spheres). A sphere that rests on the skin touches many triangles
/// at the start of a frame, and then nothing that it touches later matters. So a pair is first tested at the start; all
/// others wait until every pair of the frame is known.
class SphereFinder {
 public:
  SphereFinder(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), map_(map), surface_(options.surface), method_(options.method) {}

  /// Offers a pair, given the triangle's corners. The order of the pairs of a frame does not matter.
  void offer(const DetectorFrame& frame, const MovingCorners& corners, const Segment& segment, std::uint32_t triangle);

  /// Offers the pairs of a sphere with the triangles of a meshlet whose bits are set. Of many that it touches at the
  /// start, only the nearest are looked at closely.
  void offer(const DetectorFrame& frame, const MeshletPlaces& meshlet, const Segment& segment, std::uint32_t bits);

  /// Writes the winners of all pairs that were offered since the last call into their columns of `row`.
  SphereCounts finish(const DetectorFrame& frame, ContactRow& row);

 private:
  /// A sphere's best contact so far. `start` exists if it touches at the start.
  struct Best {
    SpherePair pair;
    FirstTouch touch;
    std::optional<StartDistance> start;
  };
  struct Waiting {
    std::uint32_t column;
    SpherePair pair;
  };

  bool touches_at_start(const StartDistance& distance, double radius);
  bool is_better(const Best& candidate, const Best& best);
  bool is_on_surface(const DetectorFrame& frame, const SpherePair& pair, const FirstTouch& touch) const;
  void take(const DetectorFrame& frame, std::uint32_t column, const Best& candidate);
  std::optional<Best>& best_of(std::uint32_t column);
  void wait(const DetectorFrame& frame, std::uint32_t column, const SpherePair& pair);
  void make_room(const DetectorFrame& frame);
  void decide_waiting(const DetectorFrame& frame);
  bool surely_touches_at_start(std::uint32_t column);
  double best_at_most(std::uint32_t column);
  std::uint32_t rest_of(const Segment& segment, std::uint32_t bits);
  bool surely_loses(double best_at_most, double radius, double at_least, double to_a_corner_at_most);
  void offer(const DetectorFrame& frame, std::uint32_t column, const SpherePair& pair);

  const Avatar& avatar_;
  const ActuatorMap& map_;
  Surface surface_;
  Method method_;
  std::vector<std::optional<Best>> best_;  ///< by column
  std::vector<std::uint32_t> columns_;     ///< those that have a best contact
  std::vector<Waiting> waiting_;           ///< pairs that do not touch at the start
  StartBounds bounds_ = {};                ///< of the meshlet that is offered
  SphereCounts counts_;
};

}  // namespace vestige
