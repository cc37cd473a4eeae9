#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "analysis/viz/seen.hpp"
#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"
#include "traces/viz/viz_bodies.hpp"

namespace vestige {

struct VizBuilder;

/// Encodes what viewers show of the skin, as foxglove.SceneUpdate. The result of a call is valid until the next call.
/// Leaves out people who are not there. Precondition of each call: the bodies have taken the frame.
class BodyScene {
 public:
  /// Keeps references to avatars, maps and `bodies`. `collider_ids` belong to the columns of rows.
  BodyScene(std::span<const MappedPerson> people, std::span<const std::uint32_t> collider_ids, const VizBodies& bodies);
  ~BodyScene();
  BodyScene(const BodyScene&) = delete;
  BodyScene& operator=(const BodyScene&) = delete;

  /// Returns a sphere for each contact, in the frame of the joint that moves the skin there most, so that it stays on
  /// the skin. It disappears after `kContactShown_ns`, or when the same collider touches the same person again.
  mcap::Bytes contacts(const TraceFrame& frame, std::span<const SeenPerson> seen);
  /// Returns each person's posed skin as a list of triangles, in the colours of the actuators' regions. Positions are
  /// rounded to 2⁻¹³ m (0.12 mm), since such numbers compress better. Deletes the skin of whoever has gone since the
  /// last message.
  mcap::Bytes skin(const TraceFrame& frame);

  static constexpr std::int32_t kContactShown_ns = 200'000'000;

 private:
  struct Skin {
    std::vector<std::uint32_t> indices;
    std::vector<std::uint16_t> actuator;  ///< of each vertex; 0: none
  };

  std::vector<MappedPerson> people_;
  std::vector<std::uint32_t> collider_ids_;
  std::vector<Skin> skins_;      ///< one for each person
  std::set<std::string> shown_;  ///< skins of the last message
  std::unique_ptr<VizBuilder> builder_;
  const VizBodies& bodies_;
};

}  // namespace vestige
