#pragma once

#include <memory>

#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"

namespace vestige {

/// `geometry` with Skip::kOn.
std::unique_ptr<Detector> make_skipping_geometry_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                          const ActuatorMap& map, const DetectorOptions& options);

}  // namespace vestige
