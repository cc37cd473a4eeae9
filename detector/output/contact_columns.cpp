#include "detector/output/contact_columns.hpp"

#include <utility>

namespace vestige {

std::vector<Hdf5Column::Description> contact_columns(OptionalColumns optional) {
  const Hdf5Library& h5 = hdf5();
  const auto column = [](const char* name, hid_t type, std::size_t bytes, const char* units, const char* description) {
    return Hdf5Column::Description{name, type, bytes, {}, units, {}, description};
  };
  std::vector<Hdf5Column::Description> columns = {
      column("frame", h5.uint64, 8, "", "number of the frame in the trace"),
      column("time_s", h5.float64, 8, "s", "time of the frame"),
      column("collider", h5.uint32, 4, "", "id of the collider in the trace"),
      column("triangle", h5.uint32, 4, "", "triangle of the avatar, from 0 on"),
      column("t", h5.float32, 4, "1", "when within the frame's step: 0 at its start, 1 at its end"),
      column("u", h5.float64, 8, "1", "weight of the triangle's second vertex"),
      column("v", h5.float64, 8, "1", "weight of the triangle's third vertex"),
      column("texture_u", h5.float64, 8, "1", "texture coordinate, not wrapped"),
      column("texture_v", h5.float64, 8, "1", "texture coordinate, not wrapped"),
      column("actuator", h5.uint16, 2, "", "from 1 on; 0 if no actuator covers the skin there"),
      column("side", h5.int8, 1, "", "+1 entering, -1 leaving, 0 coplanar"),
      column("x", h5.float64, 8, "m", "place in the world"),
      column("y", h5.float64, 8, "m", "place in the world; up"),
      column("z", h5.float64, 8, "m", "place in the world")};
  if (optional.shape == ColliderShape::kSpheres)
    columns.push_back(column("depth", h5.float64, 8, "m", "how deep a sphere is in the body at the frame's end"));
  if (optional.has_avatars)
    columns.push_back(column("avatar", h5.uint16, 2, "", "number of the person who was touched, from 1 on"));
  return columns;
}

ContactColumns::ContactColumns(hid_t where, const std::filesystem::path& path, OptionalColumns optional)
    : optional_(optional) {
  std::vector<Hdf5Column::Description> columns = contact_columns(optional);
  columns_.reserve(columns.size());
  for (Hdf5Column::Description& column : columns) columns_.emplace_back(where, path, std::move(column));
}

void ContactColumns::append(const RecordedContact& contact) {
  const glm::dvec2& weights = contact.barycentric;
  const glm::dvec2& texture = contact.texture_coordinate;
  const glm::dvec3& place_m = contact.position_m;
  const double depth_m = contact.depth_m.value_or(0);
  const void* values[] = {&contact.frame, &contact.time_s, &contact.collider, &contact.triangle, &contact.t,
                          &weights.x,     &weights.y,      &texture.x,        &texture.y,        &contact.actuator,
                          &contact.side,  &place_m.x,      &place_m.y,        &place_m.z};
  auto column = columns_.begin();
  for (const void* value : values) (column++)->append(value);
  if (optional_.shape == ColliderShape::kSpheres) (column++)->append(&depth_m);
  if (optional_.has_avatars) column->append(&contact.avatar);
}

void ContactColumns::close() {
  for (Hdf5Column& column : columns_) column.close();
}

}  // namespace vestige
