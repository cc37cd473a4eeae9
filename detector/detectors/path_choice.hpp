#pragma once

#include <cstddef>
#include <string>

#include "detector/detector.hpp"

namespace vestige {

/// What `--detector auto` runs.
struct PickedPath {
  std::string detector;
  Skip skip = Skip::kOn;
  std::string why;  ///< one sentence, for people
};

/// The cheapest exact path for an avatar of so many triangles and so many colliders: always `cpu`, which needs no
/// driver, and where a driver draws on the processor is what `geometry` can only slow down. With skipping, unless
/// `allowed` forbids it: measured from 12 triangles on, with 1 to 400 colliders in a swarm and on the skin, brute force
/// was the cheaper one nowhere.
PickedPath pick_path(std::size_t triangles, std::size_t colliders, Skip allowed);

}  // namespace vestige
