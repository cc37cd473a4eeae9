#include "traces/trace_file/trace_messages.hpp"

#include <fmt/format.h>
#include <schemas/collider_frame_3_generated.h>
#include <schemas/event_generated.h>
#include <schemas/pose_frame_generated.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "traces/mcap/decode.hpp"
#include "traces/scene/radius.hpp"

namespace vestige {

namespace {

mcap::Bytes finished(flatbuffers::FlatBufferBuilder& builder) {
  return std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
}

std::string_view text_of(const flatbuffers::String* text) {
  return text == nullptr ? std::string_view() : std::string_view(text->c_str(), text->size());
}

/// Returns an id that occurs twice, if there is one. Sorts `ids`.
std::optional<std::uint32_t> find_duplicate(std::vector<std::uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  return twice == ids.end() ? std::nullopt : std::optional(*twice);
}

/// Throws `mcap::Malformed` if the frame has another number of radii or owners than colliders, or a radius that none
/// can have.
void require_valid(const trace::ColliderFrame& table) {
  const std::size_t colliders = table.colliders() == nullptr ? 0 : table.colliders()->size();
  if (const auto* owners = table.owners(); owners != nullptr && owners->size() != colliders)
    throw mcap::Malformed(fmt::format("it has {} colliders, but {} owners", colliders, owners->size()));
  const auto* radii = table.radii();
  if (radii == nullptr) return;
  if (radii->size() != colliders)
    throw mcap::Malformed(fmt::format("it has {} colliders, but {} radii", colliders, radii->size()));
  for (unsigned i = 0; i < radii->size(); ++i)
    if (const std::string_view fault = radius_fault(double{radii->Get(i)}); !fault.empty())
      throw mcap::Malformed(fmt::format("the radius of collider {} {}", table.colliders()->Get(i)->id(), fault));
}

}  // namespace

std::string dropped_topic(const TraceEvent& event) {
  constexpr std::size_t kMostBytes = 200;
  return std::string(event.text.substr(0, kMostBytes));
}

struct MessageEncoder::Builder {
  flatbuffers::FlatBufferBuilder buffer;
};

MessageEncoder::MessageEncoder() : builder_(std::make_unique<Builder>()) {}
MessageEncoder::~MessageEncoder() = default;

mcap::Bytes MessageEncoder::pose(std::int64_t time_ns, const Pose& pose) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  trace::NodeLocal* target = nullptr;
  const auto nodes = buffer.CreateUninitializedVectorOfStructs(pose.nodes.size(), &target);
  for (const NodeLocal& node : pose.nodes) {
    *target++ =
        trace::NodeLocal(node.translation.x, node.translation.y, node.translation.z, node.rotation.x, node.rotation.y,
                         node.rotation.z, node.rotation.w, node.scale.x, node.scale.y, node.scale.z);
  }
  const trace::Position origin(pose.origin_m.x, pose.origin_m.y, pose.origin_m.z);
  buffer.Finish(trace::CreatePoseFrame(buffer, time_ns, &origin, nodes));
  return finished(buffer);
}

mcap::Bytes MessageEncoder::colliders(std::int64_t time_ns, const std::vector<ColliderSample>& colliders) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  trace::Collider* target = nullptr;
  const auto vector = buffer.CreateUninitializedVectorOfStructs(colliders.size(), &target);
  for (const ColliderSample& collider : colliders) {
    *target++ = trace::Collider(collider.id, collider.position_m.x, collider.position_m.y, collider.position_m.z);
  }
  flatbuffers::Offset<flatbuffers::Vector<float>> radii;
  if (std::ranges::any_of(colliders, [](const ColliderSample& collider) { return collider.radius_m != 0; })) {
    float* radius = nullptr;
    radii = buffer.CreateUninitializedVector(colliders.size(), &radius);
    for (const ColliderSample& collider : colliders) *radius++ = flatbuffers::EndianScalar(collider.radius_m);
  }
  flatbuffers::Offset<flatbuffers::Vector<std::uint16_t>> owners;
  if (std::ranges::any_of(colliders, [](const ColliderSample& collider) { return collider.owner != kNobody; })) {
    std::uint16_t* owner = nullptr;
    owners = buffer.CreateUninitializedVector(colliders.size(), &owner);
    for (const ColliderSample& collider : colliders) *owner++ = flatbuffers::EndianScalar(collider.owner);
  }
  buffer.Finish(trace::CreateColliderFrame(buffer, time_ns, vector, radii, owners));
  return finished(buffer);
}

mcap::Bytes MessageEncoder::event(const TraceEvent& event) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  const auto kind = buffer.CreateString(event.kind.data(), event.kind.size());
  const auto text = buffer.CreateString(event.text.data(), event.text.size());
  buffer.Finish(trace::CreateEvent(buffer, event.time_ns, kind, event.collider, event.count, text));
  return finished(buffer);
}

template <typename Table>
const Table& MessageDecoder::verified(mcap::Bytes message) {
  aligned_.resize(message.size() / sizeof(std::uint64_t) + 1);
  if (!message.empty()) std::memcpy(aligned_.data(), message.data(), message.size());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(aligned_.data());
  if (!flatbuffers::Verifier(bytes, message.size()).VerifyBuffer<Table>(nullptr))
    throw mcap::Malformed("it is not a valid FlatBuffer of its schema");
  return *flatbuffers::GetRoot<Table>(bytes);
}

std::size_t MessageDecoder::pose(mcap::Bytes message, Pose& pose) {
  const auto& table = verified<trace::PoseFrame>(message);
  pose.origin_m = glm::dvec3(0);
  if (const trace::Position* origin = table.origin()) pose.origin_m = {origin->x(), origin->y(), origin->z()};
  pose.nodes.clear();
  if (table.nodes() == nullptr) return 0;
  pose.nodes.reserve(table.nodes()->size());
  for (const trace::NodeLocal* node : *table.nodes()) {
    pose.nodes.push_back({.translation = {node->tx(), node->ty(), node->tz()},
                          .rotation = glm::quat(node->rw(), node->rx(), node->ry(), node->rz()),
                          .scale = {node->sx(), node->sy(), node->sz()}});
  }
  return pose.nodes.size();
}

std::size_t MessageDecoder::pose_node_count(mcap::Bytes message) {
  const auto* nodes = verified<trace::PoseFrame>(message).nodes();
  return nodes == nullptr ? 0 : nodes->size();
}

std::int64_t MessageDecoder::pose_time_ns(mcap::Bytes message) {
  return verified<trace::PoseFrame>(message).time_ns();
}

std::int64_t MessageDecoder::colliders_time_ns(mcap::Bytes message) {
  return verified<trace::ColliderFrame>(message).time_ns();
}

void MessageDecoder::colliders(mcap::Bytes message, std::vector<ColliderSample>& colliders) {
  const auto& table = verified<trace::ColliderFrame>(message);
  const auto* vector = table.colliders();
  colliders.clear();
  require_valid(table);
  if (vector == nullptr) return;
  colliders.reserve(vector->size());
  bool ascending = true;
  for (const trace::Collider* collider : *vector) {
    if (!colliders.empty() && collider->id() <= colliders.back().id) ascending = false;
    colliders.push_back({.id = collider->id(), .position_m = {collider->x(), collider->y(), collider->z()}});
  }
  if (const auto* radii = table.radii())
    for (std::size_t i = 0; i < colliders.size(); ++i) colliders[i].radius_m = radii->Get(static_cast<unsigned>(i));
  if (const auto* owners = table.owners())
    for (std::size_t i = 0; i < colliders.size(); ++i) colliders[i].owner = owners->Get(static_cast<unsigned>(i));
  if (ascending) return;
  ids_.clear();
  for (const ColliderSample& collider : colliders) ids_.push_back(collider.id);
  if (const auto twice = find_duplicate(ids_)) {
    colliders.clear();
    throw mcap::Malformed(fmt::format("it has collider {} twice", *twice));
  }
}

TraceEvent MessageDecoder::event(mcap::Bytes message) {
  const auto& table = verified<trace::Event>(message);
  return {.time_ns = table.time_ns(),
          .kind = text_of(table.kind()),
          .collider = table.collider(),
          .count = table.count(),
          .text = text_of(table.text())};
}

}  // namespace vestige
