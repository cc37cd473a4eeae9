#pragma once

#include <vector>

#include "detector/gl/gl_functions.hpp"
#include "detector/shader_arithmetic.hpp"

namespace vestige {

/// Runs the probe in the vertex and the geometry stage of the current context, the stages that `geometry` proves with.
/// Such a probe proves nothing, but it tells. Throws `Error` if the driver does not accept a shader.
std::vector<StageArithmetic> probe_arithmetic(const GlFunctions& gl);

}  // namespace vestige
