#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"
#include "transport/vmc/vmc_messages.hpp"

namespace vestige {

/// Says the colliders of a trace's frames by Vestige's own messages, which `VmcState` takes. Every frame is complete:
/// it says where each collider is, and that all others of the trace are gone. So a later frame corrects a lost
/// datagram, except that teleports are said once.
class ColliderTeller {
 public:
  enum class Path : std::uint8_t {
    kMotion,     ///< colliders moved here from the frame before
    kTeleports,  ///< all of them jumped here
  };

  /// `ids` are those of the whole trace, ascending.
  explicit ColliderTeller(std::span<const std::uint32_t> ids) : ids_(ids.begin(), ids.end()) {}

  /// Appends a frame's messages. Leaves out colliders that messages cannot say, as if they were absent: limbs of
  /// people; ids of 32 bits; positions that are not finite or beyond 1e9 m; radii that a collider cannot have. Calls
  /// `tell` once for limbs, and once for all others.
  void append(const TraceFrame& frame, Path path, const std::function<void(const std::string&)>& tell,
              std::vector<OscBytes>& out);
  /// Returns messages saying that all colliders are gone.
  std::vector<OscBytes> removals() const;

  /// The ids of colliders that were left out of some frame.
  const std::set<std::uint32_t>& left_out() const { return left_out_; }

 private:
  bool can_be_said(const ColliderSample& collider, const std::function<void(const std::string&)>& tell);

  std::vector<std::uint32_t> ids_;
  std::set<std::uint32_t> left_out_;
  bool told_of_limbs_ = false;
  bool told_of_others_ = false;
};

}  // namespace vestige
