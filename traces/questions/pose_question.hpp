#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/exchange/convention.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Asks whether a file of poses has the axes and the units by which it was read. Bones keep their length while a body
/// moves, so almost every joint stands in its parent as it does at rest. Where joints do not, but would with the axes
/// of a program or in another unit, these are named. Likewise, few joints are ever turned by far more than a right
/// angle: where almost all are, and would not be had their quaternions been written w,x,y,z, this is asked.
///
/// It cannot tell where a file places only joints in the body's middle, or none.
class PoseQuestion {
 public:
  /// Keeps a reference to the avatar. `convention` is the one by which the poses were read. `placed` says for each node
  /// whether the file tells where it is; the others stand as at rest in any convention.
  PoseQuestion(const Avatar& avatar, const Convention& convention, const std::vector<bool>& placed);

  void see(const TraceFrame& frame);

  /// Returns sentences such as "14 of 20 joints do not stand in their parents as at rest; 20 of them would with
  /// --pose-axes unity". Returns nothing if there is nothing to ask.
  std::vector<std::string> ask() const;

 private:
  std::string doubt_of_joints() const;
  std::string doubt_of_quaternions() const;
  std::string doubt_of_times() const;

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

  std::vector<std::uint64_t> turned_;       ///< for each node: the frames in which it is not turned as at rest
  std::vector<std::uint64_t> wrong_order_;  ///< for each node: the frames in which its numbers look like w,x,y,z
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace vestige
