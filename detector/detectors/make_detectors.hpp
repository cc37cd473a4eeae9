#pragma once

#include <memory>
#include <string_view>

#include "detector/actuator_map.hpp"
#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

class GlContext;

// Several detectors may share a context: each sets all of the context's state that it depends on before it draws.

/// Runs on the CPU: fp32 skinning by the contract, boxes that reject pairs, exact decisions for the rest.
std::unique_ptr<Detector> make_cpu_detector(const Avatar& avatar, const ActuatorMap& map,
                                            const DetectorOptions& options);

/// The slow reference: decides every pair in exact arithmetic.
std::unique_ptr<Detector> make_exact_detector(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options);

/// The published method: HAVE 2010 §III. Needs OpenGL 4.5. Throws `Error` with the driver's own message
/// otherwise.
std::unique_ptr<Detector> make_paper_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                              const ActuatorMap& map, const DetectorOptions& options);

/// A geometry shader proves misses and captures the pairs that it cannot prove to miss. The CPU decides those pairs
/// exactly. Needs OpenGL 4.5. Throws `Error` with the driver's own message otherwise, and as `require_proofs` does.
std::unique_ptr<Detector> make_geometry_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                 const ActuatorMap& map, const DetectorOptions& options);

/// The same contacts, with a compute shader in place of the geometry shader. Needs and throws the same.
std::unique_ptr<Detector> make_compute_detector(std::shared_ptr<GlContext> context, const Avatar& avatar,
                                                const ActuatorMap& map, const DetectorOptions& options);

/// Throws `Error` with the cause if the proofs of `detector`, `geometry` or `compute`, do not hold with the arithmetic
/// of this driver, or if that was not measured.
void require_proofs(std::string_view detector, const GlInfo& gl);

}  // namespace vestige
