#pragma once

#include <memory>

#include "detector/actuator_map.hpp"
#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

class GlContext;

/// On the CPU: fp32 skinning by the contract, boxes reject, exact decisions.
std::unique_ptr<Detector> make_cpu_detector(const Avatar& avatar, const ActuatorMap& map,
                                            const DetectorOptions& options);

/// The slow truth: every pair in exact arithmetic.
std::unique_ptr<Detector> make_exact_detector(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options);

/// The published method: HAVE 2010 §III. Needs OpenGL 4.5; throws `Error` with the driver's own words otherwise.
std::unique_ptr<Detector> make_paper_detector(std::unique_ptr<GlContext> context, const Avatar& avatar,
                                              const ActuatorMap& map, const DetectorOptions& options);

/// A geometry shader proves misses and captures what it cannot prove; the CPU decides that, exactly. Needs OpenGL 4.5;
/// throws `Error` with the driver's own words otherwise.
std::unique_ptr<Detector> make_geometry_detector(std::unique_ptr<GlContext> context, const Avatar& avatar,
                                                 const ActuatorMap& map, const DetectorOptions& options);

}  // namespace vestige
