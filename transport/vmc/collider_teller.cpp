#include "transport/vmc/collider_teller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "traces/scene/radius.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr std::uint32_t kLargestId = std::numeric_limits<std::int32_t>::max();

bool is_known(std::uint32_t id) {
  return id <= kLargestId;
}

/// Returns why no message can say a collider that is nobody's limb. Empty if one can.
std::string fault_of(const ColliderSample& collider) {
  if (!is_known(collider.id)) return fmt::format("its id is larger than {}", kLargestId);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(collider.position_m[axis])) return "its position is not finite";
    if (std::abs(collider.position_m[axis]) > trace_format::kFarthest_m)
      return fmt::format("its position is beyond {:g} m", trace_format::kFarthest_m);
  }
  if (const std::string_view fault = radius_fault(double{collider.radius_m}); !fault.empty())
    return fmt::format("its radius {}", fault);
  return {};
}

}  // namespace

bool ColliderTeller::can_be_said(const ColliderSample& collider, const std::function<void(const std::string&)>& tell) {
  if (collider.owner != kNobody) {
    if (!std::exchange(told_of_limbs_, true))
      tell(
          "colliders that are limbs of people are not sent, since no message says whose they are\n  The receiver can "
          "make limbs from the poses: record --live … --limbs PARTS.");
    left_out_.insert(collider.id);
    return false;
  }
  const std::string fault = fault_of(collider);
  if (fault.empty()) return true;
  if (!std::exchange(told_of_others_, true))
    tell(fmt::format("collider {} cannot be sent: {}; such colliders are left out", collider.id, fault));
  left_out_.insert(collider.id);
  return false;
}

void ColliderTeller::append(const TraceFrame& frame, Path path, const std::function<void(const std::string&)>& tell,
                            std::vector<OscBytes>& out) {
  std::vector<std::uint32_t> present;
  for (const ColliderSample& collider : frame.colliders) {
    if (!can_be_said(collider, tell)) continue;
    present.push_back(collider.id);
    out.push_back(collider_message(collider));
  }
  std::ranges::sort(present);
  const auto is_present = [&](std::uint32_t id) { return std::ranges::binary_search(present, id); };
  for (const std::uint32_t id : path == Path::kTeleports ? present : frame.teleported)
    if (is_present(id)) out.push_back(teleport_message(id));
  for (const std::uint32_t id : ids_)
    if (is_known(id) && !is_present(id)) out.push_back(removal_message(id));
}

std::vector<OscBytes> ColliderTeller::removals() const {
  std::vector<OscBytes> messages;
  for (const std::uint32_t id : ids_)
    if (is_known(id)) messages.push_back(removal_message(id));
  return messages;
}

}  // namespace vestige
