#pragma once

#include "traces/scene/avatar.hpp"
#include "traces/scene/stance.hpp"

namespace vestige {

/// How two people stand for the scenario `touch`: face to face, an arm's length apart.
struct TouchStances {
  Stance giver;
  Stance receiver;
};
TouchStances touch_stances(const Avatar& giver, const Avatar& receiver);

/// Returns a motion of 4 s in which the giver raises the right hand, pats the receiver's left shoulder three times
/// within the first 2 s, and lowers it. Both play `idle`, an animation that either may lack, beside it. Throws `Error`
/// if the joints of an avatar do not tell the arm, or the arm does not reach the shoulder.
Animation pat_on_shoulder(const Avatar& giver, const Avatar& receiver, const TouchStances& stances);

/// Returns the animation `idle` of an avatar; null if it has none.
const Animation* idle_of(const Avatar& avatar);

}  // namespace vestige
