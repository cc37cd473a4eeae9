#pragma once

#include <cstdint>

#include "detector/actuator_map.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Decides pairs of collider and triangle exactly, and keeps the winner of each collider: what `cpu` and `geometry`
/// have in common (detector/CONTRACT.md, 4 to 9). In which order pairs are offered changes nothing.
class ContactFinder {
 public:
  ContactFinder(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), map_(map), surface_(options.surface), method_(options.method) {}

  /// Decides the pair, the triangle's corners given, and replaces `winner`, the best contact of this segment so far, if
  /// this one is better.
  void offer(const Frame& frame, const MovingCorners& corners, const Segment& segment, std::uint32_t triangle,
             Contact& winner);

  /// Pairs offered since the last call that truly meet.
  std::uint64_t take_meeting();

  /// Pairs that took exact arithmetic since the last call.
  std::uint64_t take_unsure();

 private:
  const Avatar& avatar_;
  const ActuatorMap& map_;
  Surface surface_;
  Method method_;
  std::uint64_t meeting_ = 0;
  std::uint64_t unsure_ = 0;
};

}  // namespace vestige
