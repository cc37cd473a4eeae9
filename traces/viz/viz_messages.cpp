#include "traces/viz/viz_messages.hpp"

#include <fmt/format.h>
#include <schemas/frame_transforms_generated.h>
#include <schemas/scene_update_generated.h>

#include <cmath>
#include <string>

#include "traces/viz/viz_builder.hpp"
#include "traces/viz/viz_format.hpp"

namespace vestige {

namespace {

constexpr double kPoint_m = 0.02;  ///< diameter: a point has none, but must be visible
constexpr double kBone_m = 0.008;

using Transforms = std::vector<flatbuffers::Offset<foxglove::FrameTransform>>;

/// Puts the z axis on the y axis of the frame above.
glm::dquat z_on_y() {
  return {std::sqrt(0.5), -std::sqrt(0.5), 0, 0};
}

flatbuffers::Offset<foxglove::FrameTransform> transform(VizBuilder& builder, std::int64_t time_ns,
                                                        const std::string& parent, const std::string& child,
                                                        const VizPlacement& placement) {
  const foxglove::Time time = VizBuilder::time(time_ns);
  const auto parent_id = builder.buffer.CreateSharedString(parent);
  const auto child_id = builder.buffer.CreateSharedString(child);
  const auto translation = builder.vector(placement.position_m);
  const auto rotation = builder.quaternion(placement.rotation);
  return foxglove::CreateFrameTransform(builder.buffer, &time, parent_id, child_id, translation, rotation);
}

void add_nodes(Transforms& transforms, VizBuilder& builder, std::int64_t time_ns, const VizBody& body) {
  for (const int index : body.skeleton.node_order) {
    const auto i = static_cast<std::size_t>(index);
    const VizPlacement& place = body.node_placement[i];
    if (body.skeleton.nodes[i].parent < 0) {
      transforms.push_back(transform(builder, time_ns, body.frame, body.node_frames[i], place));
      continue;
    }
    const auto parent = static_cast<std::size_t>(body.skeleton.nodes[i].parent);
    const VizPlacement& from = body.node_placement[parent];
    const glm::dquat back = glm::conjugate(from.rotation);
    transforms.push_back(
        transform(builder, time_ns, body.node_frames[parent], body.node_frames[i],
                  {.position_m = back * (place.position_m - from.position_m), .rotation = back * place.rotation}));
  }
}

}  // namespace

VizEncoder::VizEncoder(const VizBodies& bodies) : builder_(std::make_unique<VizBuilder>()), bodies_(bodies) {}

VizEncoder::~VizEncoder() = default;

mcap::Bytes VizEncoder::transforms(const TraceFrame& frame) {
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  buffer.Clear();
  Transforms transforms;
  for (std::size_t person = 0; person < bodies_.people().size(); ++person) {
    const VizBody& body = bodies_.people()[person];
    if (!body.is_there()) continue;
    transforms.push_back(transform(*builder_, frame.time_ns, viz_format::kWorld, body.frame,
                                   {.position_m = frame.poses[person].origin_m}));
    add_nodes(transforms, *builder_, frame.time_ns, body);
    if (!upright_) upright_ = person;
    if (person != *upright_) continue;
    const VizPlacement& root = body.node_placement[static_cast<std::size_t>(body.skeleton.root_node)];
    transforms.push_back(transform(*builder_, frame.time_ns, body.frame, viz_format::kUpright,
                                   {.position_m = root.position_m, .rotation = z_on_y()}));
  }
  const auto all = buffer.CreateVector(transforms);
  buffer.Finish(foxglove::CreateFrameTransforms(buffer, all));
  return builder_->finished();
}

mcap::Bytes VizEncoder::scene(const TraceFrame& frame) {
  VizScene scene(*builder_, frame.time_ns);
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  for (std::size_t person = 0; person < bodies_.people().size(); ++person) {
    const VizBody& body = bodies_.people()[person];
    if (!body.is_there()) continue;
    std::vector<flatbuffers::Offset<foxglove::Point3>> ends;
    for (std::size_t i = 0; i < body.world.size(); ++i) {
      const int parent = body.skeleton.nodes[i].parent;
      if (parent < 0) continue;
      ends.push_back(builder_->point(body.node_placement[static_cast<std::size_t>(parent)].position_m));
      ends.push_back(builder_->point(body.node_placement[i].position_m));
    }
    const auto points = buffer.CreateVector(ends);
    const auto bone_pose = builder_->pose(glm::dvec3(0));
    const auto bone_colour = foxglove::CreateColor(buffer, 0.35, 0.55, 0.85, 1.0);
    const auto bones = foxglove::CreateLinePrimitive(buffer, foxglove::LineType::LINE_LIST, bone_pose, kBone_m, false,
                                                     points, bone_colour);
    const auto lines = buffer.CreateVector(&bones, 1);
    scene.add(body.frame, viz_name("skeleton", person), [&](auto& entity) { entity.add_lines(lines); });
  }

  const auto colour = foxglove::CreateColor(buffer, 0.9, 0.35, 0.2, 1.0);
  for (const ColliderSample& collider : frame.colliders) {
    if (!is_drawable(collider.position_m) || !std::isfinite(collider.radius_m)) continue;
    const double diameter_m = collider.radius_m > 0 ? 2 * double{collider.radius_m} : kPoint_m;
    const auto spheres = builder_->sphere(collider.position_m, diameter_m, colour);
    scene.add(viz_format::kWorld, fmt::format("collider {}", collider.id),
              [&](auto& entity) { entity.add_spheres(spheres); });
  }
  scene.delete_gone(shown_);
  scene.finish();
  return builder_->finished();
}

std::uint64_t VizEncoder::most_bytes(const TraceFrame& frame) const {
  constexpr std::uint64_t kFixedBytes = 1024;
  constexpr std::uint64_t kBodyBytes = 1024;
  constexpr std::uint64_t kNodeBytes = 384;
  constexpr std::uint64_t kEntityBytes = 448;  // of a collider, or of a deletion
  std::uint64_t bytes = kFixedBytes + kEntityBytes * (frame.colliders.size() + shown_.size());
  for (const VizBody& body : bodies_.people()) {
    bytes += kBodyBytes + kNodeBytes * body.node_frames.size();
    for (const std::string& name : body.node_frames) bytes += 2 * name.size();
  }
  return bytes;
}

}  // namespace vestige
