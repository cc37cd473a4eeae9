#pragma once

#include <memory>

#include "detector/detector.hpp"

namespace vestige {

/// How Embree builds its scene. kRobust (RTC_SCENE_FLAG_ROBUST) keeps vertices in the leaves and tests by Plücker
/// coordinates. kDefault keeps edges and normals, for Möller-Trumbore's test: a refit then has more to compute, so that
/// kRobust is the faster of the two where everything moves (87 against 117 µs for 5000 triangles, rays alike).
enum class EmbreeMode { kRobust, kDefault };

/// Opens libembree3.so.3, if it is not open yet. Throws `Error` naming the package where it is missing.
void require_embree();

/// What a user would pick instead: Embree 3's BVH (https://www.embree.org), dynamic and refitted each frame, over the
/// vertices as the CPU skins them; one ray a segment, in one thread. Contact, t and triangle are Embree's; what follows
/// from them is `describe_contact`'s. Its name is "embree" for kRobust, "embree_default" for kDefault.
///
/// Throws what `require_embree` throws, and `UsageError` for another method than `kStatic`, which Embree does not know.
std::unique_ptr<Detector> make_embree_detector(EmbreeMode mode, const Avatar& avatar, const ActuatorMap& map,
                                               const DetectorOptions& options);

}  // namespace vestige
