#include "analysis/viz/viz_trace.hpp"

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "traces/viz/viz_format.hpp"

namespace vestige {

namespace {

/// Places in the list of added channels.
enum Added : std::size_t { kTransforms, kScene, kContacts, kMesh, kActuators };

constexpr std::string_view kActuatorsSchema = R"({
  "title": "vestige.viz.Actuators",
  "type": "object",
  "properties": {
    "actuators": {
      "type": "array",
      "description": "every actuator, always in the same order",
      "items": {
        "type": "object",
        "properties": {
          "name": {"type": "string"},
          "duty": {"type": "integer", "minimum": 0, "maximum": 255, "description": "duty cycle: 0 off, 255 full"}
        },
        "required": ["name", "duty"]
      }
    }
  },
  "required": ["actuators"]
})";

mcap::Bytes bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::vector<AddedChannel> added_channels() {
  using namespace viz_format;
  const mcap::Channel on_scenes = {.topic = {}, .message_encoding = kEncoding, .metadata = {}};
  std::vector<AddedChannel> added;
  for (const mcap::Channel& channel : channels())
    added.push_back({channel, channel.id == kTransformsId ? transforms_schema() : scene_schema()});
  for (const char* topic : {kContactsTopic, kMeshTopic}) {
    added.push_back({on_scenes, scene_schema()});
    added.back().channel.topic = topic;
  }
  const mcap::Bytes schema = bytes_of(kActuatorsSchema);
  added.push_back(
      {{.topic = kActuatorsTopic, .message_encoding = "json", .metadata = {}},
       {.name = "vestige.viz.Actuators", .encoding = "jsonschema", .data = {schema.begin(), schema.end()}}});
  return added;
}

}  // namespace

VizTrace::VizTrace(const Input& input, const mcap::Writer::Sink& sink)
    : copy_(input.source, sink, added_channels()),
      bodies_(avatars_of(input.people)),
      scene_(bodies_),
      body_(input.people, input.collider_ids, bodies_),
      actuator_names_(viz_actuator_names(input.people)),
      pace_(viz_format::kRate_hz) {
  if (input.mesh_rate_hz > 0) mesh_pace_.emplace(input.mesh_rate_hz);
}

void VizTrace::add(std::size_t channel, const TraceFrame& frame, mcap::Bytes data) {
  copy_.write(channel, static_cast<std::uint32_t>(frame.index), static_cast<std::uint64_t>(frame.time_ns), data);
}

void VizTrace::write(const TraceFrame& frame, std::span<const SeenPerson> seen) {
  copy_.copy_through(frame.index);
  std::size_t contacts = 0;
  for (const SeenPerson& person : seen) contacts += person.row.hits();
  contacts_ += contacts;
  const bool is_due = pace_.is_due(frame.time_ns);
  const bool is_mesh_due = mesh_pace_ && mesh_pace_->is_due(frame.time_ns);
  if (is_due || is_mesh_due || contacts > 0) bodies_.take(frame);
  if (is_due) {
    pace_.end_slot(frame.time_ns);
    add(kTransforms, frame, scene_.transforms(frame));
    add(kScene, frame, scene_.scene(frame));
  }
  if (is_mesh_due) {
    mesh_pace_->end_slot(frame.time_ns);
    add(kMesh, frame, body_.skin(frame));
  }
  if (contacts > 0) add(kContacts, frame, body_.contacts(frame, seen));
  add_duties(frame, seen, is_due);
}

/// Every change is written. Between changes, viewers draw straight lines from message to message, so there are others.
void VizTrace::add_duties(const TraceFrame& frame, std::span<const SeenPerson> seen, bool is_due) {
  if (actuator_names_.empty()) return;
  std::vector<std::uint8_t> duties;
  for (const SeenPerson& person : seen)
    if (person.felt != nullptr) duties.insert(duties.end(), person.felt->duty.begin(), person.felt->duty.end());
  if (!is_due && duties == duties_) return;
  nlohmann::ordered_json actuators = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < duties.size(); ++i)
    actuators.push_back({{"name", actuator_names_[i]}, {"duty", duties[i]}});
  const std::string text = nlohmann::ordered_json({{"actuators", std::move(actuators)}}).dump();
  add(kActuators, frame, bytes_of(text));
  duties_ = std::move(duties);
}

}  // namespace vestige
