#include <fmt/format.h>

#include "detector/approximate/approximate_detectors.hpp"
#include "detector/approximate/capsule.hpp"
#include "detector/approximate/oriented_box.hpp"
#include "detector/approximate/shape_detector.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

template <typename Shape>
std::unique_ptr<Detector> make_detector(const char* name, const Avatar& avatar, const ActuatorMap& map,
                                        const DetectorOptions& options) {
  if (options.method == Method::kCcd)
    throw UsageError("--method", fmt::format("the {} are rigid, which 'ccd' is not for", name),
                     "choose --method carried, which looks at their whole motion");
  return std::make_unique<ShapeDetector<Shape>>(name, avatar, map, options);
}

}  // namespace

std::unique_ptr<Detector> make_boxes_detector(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options) {
  return make_detector<OrientedBox>("boxes", avatar, map, options);
}

std::unique_ptr<Detector> make_capsules_detector(const Avatar& avatar, const ActuatorMap& map,
                                                 const DetectorOptions& options) {
  return make_detector<Capsule>("capsules", avatar, map, options);
}

}  // namespace vestige
