#pragma once

#include <memory>

#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"

namespace vestige {

/// `compute` with Skip::kOn on a GPU: shaders find and skin the meshlets that segments may meet, and prove misses. The
/// CPU skins the meshlets of the pairs that are left, and decides those. A frame that GpuCuller does not take is
/// `cpu`'s.
std::unique_ptr<Detector> make_gpu_compute_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                    const ActuatorMap& map, const DetectorOptions& options);

}  // namespace vestige
