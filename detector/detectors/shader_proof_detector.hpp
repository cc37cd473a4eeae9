#pragma once

#include <memory>

#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "detector/proofs/candidate_prover.hpp"

namespace vestige {

/// `compute`, and `geometry` with Skip::kOn: the CPU finds and skins the meshlets that segments may meet, shaders of
/// this stage prove misses, and the CPU decides the rest.
std::unique_ptr<Detector> make_shader_proof_detector(std::shared_ptr<GlContext> context, ProofStage stage,
                                                     const Avatar& avatar, const ActuatorMap& map,
                                                     const DetectorOptions& options);

}  // namespace vestige
