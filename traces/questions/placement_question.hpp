#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "traces/exchange/convention.hpp"
#include "traces/questions/near_skin.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Asks whether colliders stand where their recording meant them to. If fewer than one in a hundred ever comes near the
/// skin (5 cm), they are tried in every unit, with the axes of every program, with their columns in another order, and
/// moved as a whole. What brings at least ten times as many is named. Where more of them come near, only other axes and
/// orders of columns are tried, and what fits four times better is named.
///
/// It cannot tell what looks right: colliders mirrored about the body's middle, of half the size, or of another take.
class PlacementQuestion {
 public:
  /// Keeps a reference to the avatar. `convention` is the one by which the colliders were read; afterwards the whole
  /// scene was moved by `origin_m`.
  explicit PlacementQuestion(const Avatar& avatar, const Convention& convention = {},
                             const glm::dvec3& origin_m = glm::dvec3(0))
      : sampler_(avatar), convention_(convention), origin_m_(origin_m) {
    convention_.offset_m += origin_m;
  }

  /// Looks at a frame. Keeps some of all frames, evenly spread.
  void see(const TraceFrame& frame);

  /// Returns one sentence, such as "the nearest of 100 colliders stays 120 m away from the skin; in centimetres, 84 of
  /// them would reach it: --collider-unit cm". Returns nothing if there is nothing to ask.
  std::optional<std::string> ask() const;

 private:
  SkinSampler sampler_;
  Convention convention_;  ///< with the origin in its offset
  glm::dvec3 origin_m_;
  std::vector<TraceFrame> kept_;
  std::uint64_t seen_ = 0;
  std::uint64_t step_ = 1;  ///< one frame of so many is kept
  std::set<std::uint32_t> ids_;
};

}  // namespace vestige
