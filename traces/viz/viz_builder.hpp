#pragma once

#include <schemas/scene_update_generated.h>

#include <algorithm>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/mcap/record.hpp"

namespace vestige {

/// Builds one message after the other in Foxglove's schemas. Lengths are in metres.
struct VizBuilder {
  flatbuffers::FlatBufferBuilder buffer;

  // A reader with its own schemas uses its own default values, so every field is written.
  VizBuilder() { buffer.ForceDefaults(true); }

  /// Seconds have 32 bits, which last for 136 years: times after the last second are that.
  static foxglove::Time time(std::int64_t time_ns) {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    constexpr std::int64_t kLast_ns = std::numeric_limits<std::uint32_t>::max() * kSecond_ns;
    const std::int64_t shown_ns = std::clamp<std::int64_t>(time_ns, 0, kLast_ns);
    return {static_cast<std::uint32_t>(shown_ns / kSecond_ns), static_cast<std::uint32_t>(shown_ns % kSecond_ns)};
  }
  auto vector(const glm::dvec3& v) { return foxglove::CreateVector3(buffer, v.x, v.y, v.z); }
  auto point(const glm::dvec3& v) { return foxglove::CreatePoint3(buffer, v.x, v.y, v.z); }
  auto quaternion(const glm::dquat& q) { return foxglove::CreateQuaternion(buffer, q.x, q.y, q.z, q.w); }
  auto pose(const glm::dvec3& position) {
    const auto p = vector(position);
    return foxglove::CreatePose(buffer, p, quaternion(glm::dquat(1, 0, 0, 0)));
  }
  auto sphere(const glm::dvec3& position, double diameter_m, flatbuffers::Offset<foxglove::Color> colour) {
    const auto size = vector(glm::dvec3(diameter_m));
    const auto sphere = foxglove::CreateSpherePrimitive(buffer, pose(position), size, colour);
    return buffer.CreateVector(&sphere, 1);
  }
  /// Ends the message. The result is valid until the next one begins.
  mcap::Bytes finished() {
    return std::as_bytes(std::span<const std::uint8_t>(buffer.GetBufferPointer(), buffer.GetSize()));
  }
};

/// The entities of one foxglove.SceneUpdate. They move with their frame.
class VizScene {
 public:
  /// Begins a message; `lifetime_ns` 0: what it shows stays until it is replaced.
  VizScene(VizBuilder& builder, std::int64_t time_ns, std::int32_t lifetime_ns = 0)
      : buffer_(builder.buffer), time_(VizBuilder::time(time_ns)), lifetime_(0, lifetime_ns) {
    buffer_.Clear();
  }

  /// Adds an entity, which replaces that of the same id. `fill` adds its primitives to a foxglove::SceneEntityBuilder.
  template <typename Fill>
  void add(const std::string& frame, const std::string& id, Fill fill) {
    const auto frame_id = buffer_.CreateSharedString(frame);
    const auto name = buffer_.CreateString(id);
    foxglove::SceneEntityBuilder entity(buffer_);
    entity.add_timestamp(&time_);
    entity.add_frame_id(frame_id);
    entity.add_id(name);
    entity.add_lifetime(&lifetime_);
    entity.add_frame_locked(true);
    fill(entity);
    entities_.push_back(entity.Finish());
    added_.insert(id);
  }
  /// Deletes the entities of `shown` that were not added, and keeps in it those that were.
  void delete_gone(std::set<std::string>& shown) {
    for (const std::string& id : shown)
      if (!added_.contains(id)) remove(id);
    shown = std::move(added_);
  }
  void finish() {
    const auto deletions = buffer_.CreateVector(deletions_);
    const auto entities = buffer_.CreateVector(entities_);
    buffer_.Finish(foxglove::CreateSceneUpdate(buffer_, deletions, entities));
  }

 private:
  void remove(const std::string& id) {
    const auto name = buffer_.CreateString(id);
    deletions_.push_back(
        foxglove::CreateSceneEntityDeletion(buffer_, &time_, foxglove::SceneEntityDeletionType::MATCHING_ID, name));
  }

  flatbuffers::FlatBufferBuilder& buffer_;
  foxglove::Time time_;
  foxglove::Duration lifetime_;
  std::set<std::string> added_;  ///< ids of the entities
  std::vector<flatbuffers::Offset<foxglove::SceneEntity>> entities_;
  std::vector<flatbuffers::Offset<foxglove::SceneEntityDeletion>> deletions_;
};

}  // namespace vestige
