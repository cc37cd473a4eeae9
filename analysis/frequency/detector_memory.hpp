#pragma once

#include <cstdint>
#include <optional>

#include "analysis/frequency/sweep.hpp"
#include "analysis/frequency/sweep_scene.hpp"

namespace vestige {

/// Returns the bytes of resident memory that the process needs for a second detector of this contestant, once both have
/// seen their first frames, with the colliders of the scene's first count and place. What detectors share (the OpenGL
/// context) does not count. The memory of a software renderer counts, that of a GPU does not. Pages are counted: the
/// result of a small detector is rough. Returns nothing where the system does not tell.
std::optional<std::uint64_t> detector_memory_bytes(const Contestant& contestant, const SweptPerson& person,
                                                   const SweepScene& scene);

}  // namespace vestige
