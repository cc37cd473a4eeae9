#include "analysis/viz/body_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/colours/region_colours.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/viz/viz_builder.hpp"

namespace vestige {

namespace {

constexpr double kMarker_m = 0.025;

using ColourOffset = flatbuffers::Offset<foxglove::Color>;
using Entries = std::vector<flatbuffers::Offset<foxglove::KeyValuePair>>;

glm::dvec3 rounded(const glm::dvec3& position_m) {
  constexpr double kSteps = 8192;
  return {std::round(position_m.x * kSteps) / kSteps, std::round(position_m.y * kSteps) / kSteps,
          std::round(position_m.z * kSteps) / kSteps};
}

/// Returns the node that moves a triangle's first vertex most.
std::size_t main_node(const Avatar& avatar, std::uint32_t triangle) {
  const Influences& influences = avatar.influences[avatar.triangles[triangle].x];
  const auto most = std::ranges::max_element(influences.weight) - influences.weight.begin();
  return static_cast<std::size_t>(avatar.palette[influences.palette[static_cast<std::size_t>(most)]].node);
}

/// Returns the actuator at each vertex, as one of its triangles has it.
std::vector<std::uint16_t> actuators_at_vertices(const MappedPerson& person) {
  std::vector<std::uint16_t> actuators(person.avatar.position_bind.size());
  for (std::uint32_t triangle = 0; triangle < person.avatar.triangles.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = person.avatar.triangles[triangle][corner];
      actuators[vertex] = person.map.at(triangle, glm::dvec2(person.avatar.texture_coordinate[vertex]));
    }
  return actuators;
}

ColourOffset colour_of(VizBuilder& builder, std::size_t actuator, std::size_t count) {
  const plot::Colour colour = plot::region_colour(actuator, count);
  return foxglove::CreateColor(builder.buffer, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, 1.0);
}

void add_entry(Entries& entries, VizBuilder& builder, const char* key, const std::string& value) {
  const auto name = builder.buffer.CreateSharedString(key);
  const auto text = builder.buffer.CreateSharedString(value);
  entries.push_back(foxglove::CreateKeyValuePair(builder.buffer, name, text));
}

}  // namespace

BodyScene::BodyScene(std::span<const MappedPerson> people, std::span<const std::uint32_t> collider_ids,
                     const VizBodies& bodies)
    : people_(people.begin(), people.end()),
      collider_ids_(collider_ids.begin(), collider_ids.end()),
      builder_(std::make_unique<VizBuilder>()),
      bodies_(bodies) {
  for (const MappedPerson& person : people_) {
    Skin& skin = skins_.emplace_back();
    for (const glm::uvec3& triangle : person.avatar.triangles)
      skin.indices.insert(skin.indices.end(), {triangle.x, triangle.y, triangle.z});
    skin.actuator = actuators_at_vertices(person);
  }
}

BodyScene::~BodyScene() = default;

mcap::Bytes BodyScene::contacts(const TraceFrame& frame, std::span<const SeenPerson> seen) {
  VizScene scene(*builder_, frame.time_ns, kContactShown_ns);
  // Yellow is the colour of no region, and of no collider.
  const ColourOffset yellow = foxglove::CreateColor(builder_->buffer, 1.0, 0.92, 0.1, 1.0);
  for (std::size_t person = 0; person < seen.size(); ++person) {
    const VizBody& body = bodies_.people()[person];
    if (!body.is_there()) continue;
    const ContactRow& row = seen[person].row;
    for (std::size_t column = 0; column < row.size(); ++column) {
      const Contact& contact = row[column];
      if (!contact.hit()) continue;
      const std::size_t node = main_node(people_[person].avatar, contact.triangle);
      const VizPlacement& joint = body.node_placement[node];
      const glm::dvec3 position_m = seen[person].frame.origin_m - frame.poses[person].origin_m + contact.position;
      const auto spheres =
          builder_->sphere(glm::conjugate(joint.rotation) * (position_m - joint.position_m), kMarker_m, yellow);
      const std::uint32_t collider = collider_ids_[column];
      Entries entries;
      add_entry(entries, *builder_, "frame", fmt::format("{}", frame.index));
      add_entry(entries, *builder_, "collider", fmt::format("{}", collider));
      add_entry(entries, *builder_, "triangle", fmt::format("{}", contact.triangle));
      add_entry(entries, *builder_, "actuator",
                contact.actuator == 0 ? "none" : people_[person].map.names[contact.actuator - 1U]);
      const auto metadata = builder_->buffer.CreateVector(entries);
      const std::string whom = person == 0 ? "" : fmt::format(" on person {}", person + 1);
      scene.add(body.node_frames[node], fmt::format("contact {}{}", collider, whom), [&](auto& entity) {
        entity.add_metadata(metadata);
        entity.add_spheres(spheres);
      });
    }
  }
  scene.finish();
  return builder_->finished();
}

mcap::Bytes BodyScene::skin(const TraceFrame& frame) {
  VizScene scene(*builder_, frame.time_ns);
  flatbuffers::FlatBufferBuilder& buffer = builder_->buffer;
  std::vector<glm::dvec3> positions_m;
  for (std::size_t person = 0; person < people_.size(); ++person) {
    if (!bodies_.people()[person].is_there()) continue;
    const Pose& pose = frame.poses[person];
    const std::size_t count = people_[person].map.actuator_count;
    skin_reference(people_[person].avatar, pose, pose.origin_m, positions_m);
    std::vector<flatbuffers::Offset<foxglove::Point3>> points;
    points.reserve(positions_m.size());
    for (const glm::dvec3& position_m : positions_m) points.push_back(builder_->point(rounded(position_m)));
    std::vector<ColourOffset> palette;
    for (std::size_t actuator = 0; actuator <= count; ++actuator)
      palette.push_back(colour_of(*builder_, actuator, count));
    std::vector<ColourOffset> colours;  // vertices of one colour share it
    colours.reserve(points.size());
    for (const std::uint16_t actuator : skins_[person].actuator) colours.push_back(palette[actuator]);

    const auto all_points = buffer.CreateVector(points);
    const auto all_colours = buffer.CreateVector(colours);
    const auto indices = buffer.CreateVector(skins_[person].indices);
    const auto list = foxglove::CreateTriangleListPrimitive(buffer, builder_->pose(glm::dvec3(0)), all_points,
                                                            palette.front(), all_colours, indices);
    const auto triangles = buffer.CreateVector(&list, 1);
    scene.add(bodies_.people()[person].frame, viz_name("skin", person),
              [&](auto& entity) { entity.add_triangles(triangles); });
  }
  scene.delete_gone(shown_);
  scene.finish();
  return builder_->finished();
}

}  // namespace vestige
