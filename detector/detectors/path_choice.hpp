#pragma once

#include <cstddef>
#include <string>

#include "detector/detector.hpp"

namespace vestige {

/// The detector that `--detector auto` runs.
struct PickedPath {
  std::string detector;
  Skip skip = Skip::kOn;
  std::string why;  ///< one sentence, for people
};

/// Returns the cheapest exact path for an avatar of this many triangles and this many colliders. The path is always
/// `cpu`: it needs no driver, whose arithmetic might break the proofs of `geometry`, and `geometry` can only be slower
/// if the driver draws on the CPU. The path skips unless `allowed` forbids it: brute force was never cheaper, measured
/// from 12 triangles on, with 1 to 400 colliders in a swarm and on the skin.
PickedPath pick_path(std::size_t triangles, std::size_t colliders, Skip allowed);

}  // namespace vestige
