#pragma once

#include <memory>

#include "detector/actuator_map.hpp"
#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// What vests with bounding boxes do (HAVE 2010, reference [3]: Lindeman et al. 2004): one oriented box around the skin
/// that each joint moves, fitted in the rest pose. The body's surface is that of all boxes together. Each place of a
/// box stands for the skin nearest to it. Knows the methods kStatic and kCarried; throws `UsageError` for kCcd.
///
/// The contact's triangle, barycentric, texture coordinate and actuator are those of the skin that the place stands
/// for; t, position, side and speed are those of the box.
std::unique_ptr<Detector> make_boxes_detector(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options);

/// What game engines do: as above, with one capsule for each joint.
std::unique_ptr<Detector> make_capsules_detector(const Avatar& avatar, const ActuatorMap& map,
                                                 const DetectorOptions& options);

/// The avatar simplified in its rest pose to `keep`, in (0, 1], of its triangles, or to as few as its seams and edges
/// allow (meshoptimizer). Contacts with that mesh are exact, for every method. Each sixteenth of its triangles stands
/// for the skin nearest to it; `Surface::kMapped` as for boxes.
std::unique_ptr<Detector> make_decimated_detector(double keep, const Avatar& avatar, const ActuatorMap& map,
                                                  const DetectorOptions& options);

}  // namespace vestige
