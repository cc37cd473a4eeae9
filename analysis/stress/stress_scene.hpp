#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/places/random.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What the cases of a family are made of. kLoose: `kFanTriangles` loose triangles in each frame, with a map of 16 x 16
/// texels, each its own actuator. kMannequin: the built-in avatar and map.
enum class StressBody { kLoose, kMannequin };

inline constexpr std::size_t kFanTriangles = 8;
inline constexpr std::size_t kTexels = 16;

struct StressSubject {
  Avatar avatar;
  ActuatorMap map;
};
StressSubject make_subject(StressBody body);

/// How a family's answers are judged. kTruth: by `exact::` on every pair. kMustHit: every segment leaves a closed
/// surface, so every segment must hit the surface.
enum class StressJudge { kTruth, kMustHit };

/// The cases of one family at one magnitude: a case is a column of a frame, with or without a segment.
struct StressScene {
  StressJudge judge = StressJudge::kTruth;
  std::vector<DetectorFrame> frames;
};

/// The request for a scene of at least one case. The columns of all frames add up to `cases`.
struct StressOrder {
  const StressSubject* subject = nullptr;
  double magnitude = 0;
  std::size_t cases = 0;
  Method method = Method::kStatic;  ///< kCcd aims at where the triangles are halfway between the frames
  Random random{0};
};

/// What a detector is given for `now`, one frame after `before`. A collider's id is its column: below `columns`.
DetectorFrame frame_after(const TraceFrame& before, const TraceFrame& now, const Avatar& avatar, std::size_t columns,
                          Method method);

}  // namespace vestige
