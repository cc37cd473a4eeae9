#pragma once

#include <memory>

#include "detector/detector.hpp"

namespace vestige {

/// How Embree builds its scene. kRobust (RTC_SCENE_FLAG_ROBUST) keeps vertices in the leaves and tests by Plücker
/// coordinates. kDefault keeps edges and normals, for Möller-Trumbore's test. So a refit has more to compute, and
/// kRobust is the faster of the two if everything moves (87 against 117 µs for 5000 triangles; rays take the same
/// time).
enum class EmbreeMode { kRobust, kDefault };

/// Opens libembree3.so.3, unless it is open. Throws `Error` with the package to install if the library is missing.
void require_embree();

/// The usual alternative: Embree 3's BVH (https://www.embree.org), dynamic and refitted each frame, over the vertices
/// as the CPU skins them. One ray for each segment, in one thread. The refit counts as Stage::kCandidates. Embree
/// computes contact, t and triangle; `describe_contact` computes everything that follows from them. The name is
/// "embree" for kRobust and "embree_default" for kDefault.
///
/// Throws the errors of `require_embree`. Throws `UsageError` for any method except `kStatic`, because Embree has no
/// other.
std::unique_ptr<Detector> make_embree_detector(EmbreeMode mode, const Avatar& avatar, const ActuatorMap& map,
                                               const DetectorOptions& options);

}  // namespace vestige
