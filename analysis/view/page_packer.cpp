#include "analysis/view/page_packer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "analysis/colours/region_colours.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

/// No place in a trace of a person is farther from the world's origin.
constexpr double kFarthest_m = 1e9;

/// Rounded up, so that the page promises no more than is true.
double tenths_up(double value) {
  return std::ceil(value * 10) / 10;
}

void add_mesh(PageArrays& arrays, const std::string& prefix, const Avatar& avatar) {
  std::vector<float> positions;
  std::vector<float> coordinates;
  std::vector<std::uint16_t> joints;
  std::vector<std::uint16_t> weights;
  for (const glm::vec3& position : avatar.position_bind)
    positions.insert(positions.end(), {position.x, position.y, position.z});
  for (const glm::vec2& place : avatar.texture_coordinate) coordinates.insert(coordinates.end(), {place.x, place.y});
  for (const Influences& influences : avatar.influences) {
    const PageInfluences page = page_influences(influences);
    joints.insert(joints.end(), page.palette.begin(), page.palette.end());
    weights.insert(weights.end(), page.weight.begin(), page.weight.end());
  }
  std::vector<std::uint32_t> triangles;
  for (const glm::uvec3& triangle : avatar.triangles)
    triangles.insert(triangles.end(), {triangle.x, triangle.y, triangle.z});
  arrays.add(prefix + "position_bind", positions);
  arrays.add(prefix + "texture_coordinate", coordinates);
  arrays.add(prefix + "joint", joints);
  arrays.add(prefix + "weight", weights);
  arrays.add(prefix + "triangle", triangles, 3);
}

nlohmann::ordered_json actuators_of(const ActuatorMap& map) {
  nlohmann::ordered_json actuators = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < map.actuator_count; ++i)
    actuators.push_back(
        {{"name", map.names[i]}, {"colour", plot::css(plot::region_colour(i + 1, map.actuator_count))}});
  return actuators;
}

}  // namespace

PagePacker::PagePacker(std::span<const PagePerson> people, std::vector<std::string> sides,
                       std::span<const std::uint32_t> collider_ids)
    : sides_(std::move(sides)), colliders_(collider_ids) {
  people_.reserve(people.size());
  for (const PagePerson& person : people) {
    if (person.side == 0) poses_.emplace_back(person.avatar);
    people_.push_back({person});
    people_.back().duties.last.resize(person.map.actuator_count);
  }
}

/// Takes the whole metres nearest to the first thing that has a place.
void PagePacker::find_origin(const TraceFrame& frame) {
  std::vector<glm::dvec3> places_m;
  for (const Pose& pose : frame.poses)
    if (!pose.nodes.empty()) places_m.push_back(pose.origin_m);
  for (const ColliderSample& collider : frame.colliders) places_m.push_back(collider.position_m);
  const auto found = std::ranges::find_if(places_m, [](const glm::dvec3& place_m) {
    return glm::all(glm::lessThan(glm::abs(place_m), glm::dvec3(kFarthest_m)));  // nor NaN
  });
  if (found == places_m.end()) return;
  origin_m_ = glm::round(*found);
  has_origin_ = true;
}

void PagePacker::add(const TraceFrame& frame) {
  if (!has_origin_) find_origin(frame);
  const PageRow at = {static_cast<std::uint32_t>(frame_index_.size()), frame.index, frame.time_s()};
  frame_index_.push_back(static_cast<std::uint32_t>(frame.index));
  time_ns_.push_back(static_cast<double>(frame.time_ns));
  for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i].add(at, frame.poses[i], origin_m_);
  colliders_.add(at, frame, origin_m_);
}

std::size_t PagePacker::add_contacts(std::size_t person, const DetectorFrame& frame, const ContactRow& row) {
  Contacts& all = people_[person].contacts;
  const std::size_t before = all.row.size();
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit()) continue;
    all.row.push_back(static_cast<std::uint32_t>(frame_index_.size() - 1));
    all.collider.push_back(static_cast<std::uint32_t>(column));
    all.triangle.push_back(contact.triangle);
    all.t.push_back(contact.t);
    all.barycentric.insert(all.barycentric.end(), {contact.barycentric.x, contact.barycentric.y});
    const glm::dvec3 position_m = frame.origin_m + contact.position;
    all.position_m.insert(all.position_m.end(), {position_m.x, position_m.y, position_m.z});
    all.actuator.push_back(contact.actuator);
    all.side.push_back(contact.side);
  }
  return all.row.size() - before;
}

void PagePacker::add_duties(std::size_t person, const ActuatorFrame& felt) {
  Duties& all = people_[person].duties;
  for (std::size_t i = 0; i < felt.duty.size(); ++i) {
    if (felt.duty[i] == all.last[i]) continue;
    all.last[i] = felt.duty[i];
    all.row.push_back(static_cast<std::uint32_t>(frame_index_.size() - 1));
    all.actuator.push_back(static_cast<std::uint16_t>(i));
    all.duty.push_back(felt.duty[i]);
  }
}

nlohmann::ordered_json PagePacker::finish_body(std::size_t body) {
  const Avatar& avatar = people_[body].who.avatar;
  const std::string prefix = fmt::format("body_{}/", body + 1);
  add_mesh(arrays_, prefix, avatar);
  const std::vector<double> steps = poses_[body].finish(arrays_, prefix);
  return {{"facing_deg", poses_[body].facing_deg()}, {"joints", avatar.palette.size()}, {"matrix_step", steps}};
}

nlohmann::ordered_json PagePacker::finish_person(const Person& person, const std::string& prefix) {
  const ActuatorMap& map = person.who.map;
  arrays_.add(prefix + "map_actuator", map.actuator, 1);
  const Contacts& contacts = person.contacts;
  arrays_.add(prefix + "contact_row", contacts.row, 1);
  arrays_.add(prefix + "contact_collider", contacts.collider);
  arrays_.add(prefix + "contact_triangle", contacts.triangle);
  arrays_.add(prefix + "contact_t", contacts.t);
  arrays_.add(prefix + "contact_barycentric", contacts.barycentric);
  arrays_.add(prefix + "contact_position_m", contacts.position_m);
  arrays_.add(prefix + "contact_actuator", contacts.actuator);
  arrays_.add(prefix + "contact_side", contacts.side);
  arrays_.add(prefix + "duty_row", person.duties.row, 1);
  arrays_.add(prefix + "duty_actuator", person.duties.actuator);
  arrays_.add(prefix + "duty", person.duties.duty);
  return {{"name", person.who.name},
          {"body", person.who.body},
          {"side", person.who.side},
          {"actuators", actuators_of(map)},
          {"unmapped", plot::css(plot::region_colour(0, map.actuator_count))},
          {"map", {{"width", map.width}, {"height", map.height}, {"by_triangle", map.triangle_count > 0}}}};
}

PageContent PagePacker::finish() {
  arrays_.add("frame_index", frame_index_, 1);
  arrays_.add("time_ns", time_ns_, 1);
  colliders_.finish(arrays_);
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  double error_mm = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    bodies.push_back(finish_body(i));
    error_mm = std::max(error_mm, poses_[i].largest_error_mm());
  }
  nlohmann::ordered_json people = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < people_.size(); ++i)
    people.push_back(finish_person(people_[i], fmt::format("person_{}/", i + 1)));
  PageContent content;
  content.head = {
      {"version", 1},
      {"warnings", nlohmann::ordered_json::array()},
      {"same_contact_s", kSameContact_s},
      {"unit_m", kPageUnit_m},
      {"origin_m", {origin_m_.x, origin_m_.y, origin_m_.z}},
      {"error_mm", {{"skin", tenths_up(error_mm)}, {"colliders", tenths_up(1e3 * ColliderTracks::kError_m)}}},
      {"sides", sides_},
      {"bodies", std::move(bodies)},
      {"people", std::move(people)},
      {"arrays", arrays_.table()},
      {"bytes", arrays_.byte_count()}};
  std::size_t poses = 0;
  for (const PoseKeys& body : poses_) poses += body.left_out();
  if (poses + colliders_.left_out() > 0)
    content.warn(fmt::format("{} and {} of colliders cannot be drawn: they are not finite, or too far away",
                             counted(poses, "pose"), counted(colliders_.left_out(), "place")));
  content.data = arrays_.packed();
  return content;
}

}  // namespace vestige
