#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/viz/body_scene.hpp"
#include "analysis/viz/seen.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/repair/trace_copy.hpp"
#include "traces/scene/trace.hpp"
#include "traces/viz/viz_bodies.hpp"
#include "traces/viz/viz_messages.hpp"
#include "traces/viz/viz_pace.hpp"

namespace vestige {

namespace viz_format {
inline constexpr const char* kContactsTopic = "/viz/contacts";
inline constexpr const char* kActuatorsTopic = "/viz/actuators";
inline constexpr const char* kMeshTopic = "/viz/mesh";
}  // namespace viz_format

/// Copies a trace and adds all that Foxglove and Lichtblick draw (traces/FORMAT.md, What viewers draw): skeleton,
/// colliders, contacts, duties and skin. Messages that the trace has on these topics are replaced.
class VizTrace {
 public:
  /// What to add, and to which trace. References and spans are kept.
  struct Input {
    const mcap::ByteSource& source;
    std::span<const MappedPerson> people;
    std::span<const std::uint32_t> collider_ids;  ///< all of the trace, ascending
    double mesh_rate_hz = 0;                      ///< how often the skin is added; 0: never
  };

  /// Throws what `TraceCopy` throws.
  VizTrace(const Input& input, const mcap::Writer::Sink& sink);

  /// Copies the trace up to the end of its next frame, and adds what was found in it, of each person.
  void write(const TraceFrame& frame, std::span<const SeenPerson> seen);
  /// Copies the rest.
  void finish() { copy_.finish(); }

  std::uint64_t contacts() const { return contacts_; }
  std::uint64_t bytes_written() const { return copy_.bytes_written(); }
  mcap::DamageList damages() const { return copy_.damages(); }

 private:
  void add(std::size_t channel, const TraceFrame& frame, mcap::Bytes data);
  void add_duties(const TraceFrame& frame, std::span<const SeenPerson> seen, bool is_due);

  TraceCopy copy_;
  VizBodies bodies_;
  VizEncoder scene_;
  BodyScene body_;
  std::vector<std::string> actuator_names_;
  std::vector<std::uint8_t> duties_;  ///< of the last message; empty before the first
  VizPace pace_;
  std::optional<VizPace> mesh_pace_;
  std::uint64_t contacts_ = 0;
};

}  // namespace vestige
