#include "traces/trace_file/viz_messages.hpp"

#include <fmt/format.h>
#include <schemas/frame_transforms_generated.h>
#include <schemas/scene_update_generated.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <span>
#include <utility>

#include "traces/base/embed.hpp"
#include "traces/trace_file/trace_format.hpp"

VESTIGE_EMBED(vestige_schema_frame_transforms, VESTIGE_SCHEMA_DIR "/frame_transforms.bfbs");
VESTIGE_EMBED(vestige_schema_scene_update, VESTIGE_SCHEMA_DIR "/scene_update.bfbs");

namespace vestige {

namespace {

constexpr const char* kWorld = "world";
constexpr const char* kAvatar = "avatar";
constexpr const char* kSkeleton = "skeleton";
constexpr double kPoint_m = 0.02;  ///< diameter: a point has none, but must be visible
constexpr double kBone_m = 0.008;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

foxglove::Time time_of(std::int64_t time_ns) {
  return {static_cast<std::uint32_t>(time_ns / kSecond_ns), static_cast<std::uint32_t>(time_ns % kSecond_ns)};
}

/// A node's frame: its position and its rotation, in the coordinates of its tree.
struct Placement {
  glm::dvec3 position = glm::dvec3(0);
  glm::dquat rotation = glm::dquat(1, 0, 0, 0);
};

/// Ignores the rotation of a node that is scaled to zero, or mirrored.
Placement placement_of(const glm::dmat4& matrix) {
  Placement placement = {.position = glm::dvec3(matrix[3])};
  const glm::dmat3 axes(matrix);
  const glm::dvec3 lengths(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  if (!(std::min({lengths.x, lengths.y, lengths.z}) > 0) || !(glm::determinant(axes) > 0)) return placement;
  const glm::dquat rotation = glm::quat_cast(glm::dmat3(axes[0] / lengths.x, axes[1] / lengths.y, axes[2] / lengths.z));
  const double length = glm::length(rotation);
  if (std::isfinite(length) && length > 0) placement.rotation = rotation / length;
  return placement;
}

std::vector<std::string> frame_names(const Avatar& avatar, const std::string& prefix, std::set<std::string>& taken) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) {
    std::string name = prefix + avatar.nodes[i].name;
    if (name == prefix || taken.contains(name)) name = fmt::format("{}#{}", name, i);
    while (!taken.insert(name).second) name += '_';
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

namespace viz_format {

std::vector<mcap::Schema> schemas() {
  const std::string encoding(trace_format::kEncoding);
  return {{.id = kTransformsId,
           .name = "foxglove.FrameTransforms",
           .encoding = encoding,
           .data = VESTIGE_EMBEDDED(vestige_schema_frame_transforms)},
          {.id = kSceneId,
           .name = "foxglove.SceneUpdate",
           .encoding = encoding,
           .data = VESTIGE_EMBEDDED(vestige_schema_scene_update)}};
}

std::vector<mcap::Channel> channels() {
  const std::string encoding(trace_format::kEncoding);
  return {{.id = kTransformsId,
           .schema_id = kTransformsId,
           .topic = kTransformsTopic,
           .message_encoding = encoding,
           .metadata = {}},
          {.id = kSceneId, .schema_id = kSceneId, .topic = kSceneTopic, .message_encoding = encoding, .metadata = {}}};
}

}  // namespace viz_format

struct VizEncoder::Builder {
  flatbuffers::FlatBufferBuilder buffer;

  // A reader with its own schemas uses its own default values, so every field is written.
  Builder() { buffer.ForceDefaults(true); }

  auto vector(const glm::dvec3& v) { return foxglove::CreateVector3(buffer, v.x, v.y, v.z); }
  auto point(const glm::dvec3& v) { return foxglove::CreatePoint3(buffer, v.x, v.y, v.z); }
  auto quaternion(const glm::dquat& q) { return foxglove::CreateQuaternion(buffer, q.x, q.y, q.z, q.w); }
  auto pose(const glm::dvec3& position) {
    const auto p = vector(position);
    return foxglove::CreatePose(buffer, p, quaternion(glm::dquat(1, 0, 0, 0)));
  }
  auto transform(const foxglove::Time& time, const std::string& parent, const std::string& child,
                 const Placement& placement) {
    const auto parent_id = buffer.CreateSharedString(parent);
    const auto child_id = buffer.CreateSharedString(child);
    const auto translation = vector(placement.position);
    const auto rotation = quaternion(placement.rotation);
    return foxglove::CreateFrameTransform(buffer, &time, parent_id, child_id, translation, rotation);
  }
  mcap::Bytes finished() {
    return std::as_bytes(std::span<const std::uint8_t>(buffer.GetBufferPointer(), buffer.GetSize()));
  }
};

VizEncoder::VizEncoder(const std::vector<const Avatar*>& avatars) : builder_(std::make_unique<Builder>()) {
  const auto of_person = [](const char* name, std::size_t person) {
    return person == 0 ? std::string(name) : fmt::format("{} {}", name, person + 1);
  };
  std::set<std::string> taken = {kWorld};
  for (std::size_t person = 0; person < avatars.size(); ++person) taken.insert(of_person(kAvatar, person));
  for (std::size_t person = 0; person < avatars.size(); ++person) {
    Body& body = bodies_.emplace_back();
    body.skeleton.nodes = avatars[person]->nodes;
    body.skeleton.node_order = avatars[person]->node_order;
    body.frame = of_person(kAvatar, person);
    body.entity = of_person(kSkeleton, person);
    body.frames = frame_names(*avatars[person], person == 0 ? "" : fmt::format("{}/", person + 1), taken);
    for (const std::string& name : body.frames) name_bytes_ += name.size();
    frame_count_ += body.frames.size();
  }
}

VizEncoder::~VizEncoder() = default;

mcap::Bytes VizEncoder::transforms(const TraceFrame& frame) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  const foxglove::Time time = time_of(frame.time_ns);
  std::vector<flatbuffers::Offset<foxglove::FrameTransform>> transforms;
  for (std::size_t person = 0; person < bodies_.size(); ++person) {
    Body& body = bodies_[person];
    world_matrices(body.skeleton, frame.poses[person], body.world);
    transforms.push_back(builder_->transform(time, kWorld, body.frame, {.position = frame.poses[person].origin_m}));
    std::vector<Placement> placements(body.world.size());
    for (const int index : body.skeleton.node_order) {
      const auto i = static_cast<std::size_t>(index);
      placements[i] = placement_of(body.world[i]);
      const int parent = body.skeleton.nodes[i].parent;
      if (parent < 0) {
        transforms.push_back(builder_->transform(time, body.frame, body.frames[i], placements[i]));
        continue;
      }
      const Placement& from = placements[static_cast<std::size_t>(parent)];
      const glm::dquat back = glm::conjugate(from.rotation);
      transforms.push_back(builder_->transform(
          time, body.frames[static_cast<std::size_t>(parent)], body.frames[i],
          {.position = back * (placements[i].position - from.position), .rotation = back * placements[i].rotation}));
    }
  }
  const auto all = buffer.CreateVector(transforms);
  buffer.Finish(foxglove::CreateFrameTransforms(buffer, all));
  return builder_->finished();
}

mcap::Bytes VizEncoder::scene(const TraceFrame& frame) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  const foxglove::Time time = time_of(frame.time_ns);
  const foxglove::Duration for_ever(0, 0);
  std::vector<flatbuffers::Offset<foxglove::SceneEntity>> entities;
  const auto add_entity = [&](const std::string& frame_id, const std::string& id, auto fill) {
    const auto frame_name = buffer.CreateSharedString(frame_id);
    const auto name = buffer.CreateString(id);
    foxglove::SceneEntityBuilder entity(buffer);
    entity.add_timestamp(&time);
    entity.add_frame_id(frame_name);
    entity.add_id(name);
    entity.add_lifetime(&for_ever);
    entity.add_frame_locked(true);
    fill(entity);
    entities.push_back(entity.Finish());
  };

  for (std::size_t person = 0; person < bodies_.size(); ++person) {
    Body& body = bodies_[person];
    world_matrices(body.skeleton, frame.poses[person], body.world);
    std::vector<flatbuffers::Offset<foxglove::Point3>> ends;
    for (std::size_t i = 0; i < body.world.size(); ++i) {
      const int parent = body.skeleton.nodes[i].parent;
      if (parent < 0) continue;
      ends.push_back(builder_->point(glm::dvec3(body.world[static_cast<std::size_t>(parent)][3])));
      ends.push_back(builder_->point(glm::dvec3(body.world[i][3])));
    }
    const auto points = buffer.CreateVector(ends);
    const auto bone_pose = builder_->pose(glm::dvec3(0));
    const auto bone_colour = foxglove::CreateColor(buffer, 0.35, 0.55, 0.85, 1.0);
    const auto bones = foxglove::CreateLinePrimitive(buffer, foxglove::LineType::LINE_LIST, bone_pose, kBone_m, false,
                                                     points, bone_colour);
    const auto lines = buffer.CreateVector(&bones, 1);
    add_entity(body.frame, body.entity, [&](auto& entity) { entity.add_lines(lines); });
  }

  const auto colour = foxglove::CreateColor(buffer, 0.9, 0.35, 0.2, 1.0);
  std::set<std::uint32_t> shown;
  for (const ColliderSample& collider : frame.colliders) {
    shown.insert(collider.id);
    const double diameter_m = collider.radius_m > 0 ? 2 * double{collider.radius_m} : kPoint_m;
    const auto size = builder_->vector(glm::dvec3(diameter_m));
    const auto sphere = foxglove::CreateSpherePrimitive(buffer, builder_->pose(collider.position_m), size, colour);
    const auto spheres = buffer.CreateVector(&sphere, 1);
    add_entity(kWorld, fmt::format("collider {}", collider.id), [&](auto& entity) { entity.add_spheres(spheres); });
  }

  std::vector<flatbuffers::Offset<foxglove::SceneEntityDeletion>> deletions;
  for (const std::uint32_t id : shown_) {
    if (shown.contains(id)) continue;
    const auto name = buffer.CreateString(fmt::format("collider {}", id));
    deletions.push_back(
        foxglove::CreateSceneEntityDeletion(buffer, &time, foxglove::SceneEntityDeletionType::MATCHING_ID, name));
  }
  shown_ = std::move(shown);
  const auto all_deletions = buffer.CreateVector(deletions);
  const auto all_entities = buffer.CreateVector(entities);
  buffer.Finish(foxglove::CreateSceneUpdate(buffer, all_deletions, all_entities));
  return builder_->finished();
}

std::uint64_t VizEncoder::most_bytes(const TraceFrame& frame) const {
  constexpr std::uint64_t kFixedBytes = 1024;
  constexpr std::uint64_t kBodyBytes = 1024;
  constexpr std::uint64_t kNodeBytes = 384;
  constexpr std::uint64_t kColliderBytes = 448;
  return kFixedBytes + kBodyBytes * bodies_.size() + 2 * name_bytes_ + kNodeBytes * frame_count_ +
         kColliderBytes * (frame.colliders.size() + shown_.size());
}

}  // namespace vestige
