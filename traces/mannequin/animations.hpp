#pragma once

#include <string>
#include <vector>

#include "traces/mannequin/skeleton.hpp"

namespace vestige::mannequin {

/// A looping motion: `poses` at equal intervals from 0 to `duration_s`; the last equals the first.
struct Motion {
  std::string name;
  double duration_s;
  std::vector<JointPose> poses;
};

/// Returns the motions `idle` (breathing, weight shifting from foot to foot), `walk` (on the spot), `reach` (each arm
/// in turn, forward and up) and `spin` (a full turn with the arms out). The lower foot always stands on the ground.
std::vector<Motion> make_motions();

}  // namespace vestige::mannequin
