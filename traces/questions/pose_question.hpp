#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/exchange/convention.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Asks whether a file of poses has the axes and the unit by which it was read. Bones keep their length while a body
/// moves, so almost every joint stands in its parent as it does at rest. Where joints do not, but would with the axes
/// of a program or in another unit, these are named.
///
/// It cannot tell where a file places only joints in the body's middle, or none.
class PoseQuestion {
 public:
  /// Keeps a reference to the avatar. `convention` is the one by which the poses were read. `placed` says for each node
  /// whether the file tells where it is; the others stand as at rest in any convention.
  PoseQuestion(const Avatar& avatar, const Convention& convention, const std::vector<bool>& placed);

  void see(const TraceFrame& frame);

  /// Returns one sentence, such as "14 of 20 joints do not stand in their parents as at rest; with the axes of unity,
  /// all of them would: --pose-axes unity". Returns nothing if there is nothing to ask.
  std::optional<std::string> ask() const;

 private:
  struct Reading {
    Convention convention;
    std::string flags;
    std::vector<std::uint64_t> as_at_rest;  ///< for each joint: the frames in which it stands as at rest
  };
  const Avatar& avatar_;
  Convention convention_;
  std::vector<int> joints_;        ///< placed nodes with a parent, away from it at rest
  std::vector<Reading> readings_;  ///< the first is `convention_`
  std::uint64_t frames_ = 0;
};

}  // namespace vestige
