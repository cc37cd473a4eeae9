#pragma once

#include <string>
#include <vector>

#include "traces/mannequin/skeleton.hpp"

namespace vestige::mannequin {

/// A loop: `poses` at even times from 0 to `duration_s`, the last equal to the first.
struct Motion {
  std::string name;
  double duration_s;
  std::vector<JointPose> poses;
};

/// `idle` (breathing, weight shifting from foot to foot), `walk` (on the spot), `reach` (each arm in turn, forward and
/// up), `spin` (a full turn with the arms out). In each, the lower foot stands on the ground.
std::vector<Motion> make_motions();

}  // namespace vestige::mannequin
