#include "analysis/plot/paraview/paraview_series.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <array>
#include <regex>
#include <utility>

#include "analysis/base/html.hpp"
#include "traces/base/error.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige::plot {

namespace {

constexpr std::array<const char*, 3> kParts = {"avatar", "colliders", "contacts"};

std::string file_name(const char* part, std::size_t step) {
  return fmt::format("{}_{:06}.vtp", part, step);
}

bool is_one_of_ours(const std::filesystem::path& file) {
  static const std::regex pattern("(avatar|colliders|contacts)_[0-9]{6,}\\.vtp");
  return std::regex_match(file.filename().string(), pattern);
}

template <typename Array>
vtkNew<Array> new_array(const char* name, std::size_t count) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(count));
  return array;
}

/// Points, each a cell of its own: what has no cell is not drawn.
template <typename Place, typename Items>
vtkNew<vtkPolyData> point_cloud(const Items& items, const Place& place) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const auto& item : items) {
    const glm::dvec3 at = place(item);
    const vtkIdType id = points->InsertNextPoint(at.x, at.y, at.z);
    cells->InsertNextCell(1, &id);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  return data;
}

template <typename Array, typename Items, typename Value>
void add_point_data(vtkPolyData& data, const char* name, const Items& items, const Value& value) {
  auto array = new_array<Array>(name, items.size());
  vtkIdType next = 0;
  for (const auto& item : items) array->SetValue(next++, value(item));
  data.GetPointData()->AddArray(array);
}

vtkSmartPointer<vtkPolyData> collider_cloud(std::span<const ColliderSample> colliders) {
  auto cloud = point_cloud(colliders, [](const ColliderSample& one) { return one.position_m; });
  add_point_data<vtkUnsignedIntArray>(*cloud, "collider", colliders, [](const auto& one) { return one.id; });
  add_point_data<vtkFloatArray>(*cloud, "radius_m", colliders, [](const auto& one) { return one.radius_m; });
  return cloud;
}

vtkSmartPointer<vtkPolyData> contact_cloud(std::span<const PlacedContact> contacts) {
  auto cloud = point_cloud(contacts, [](const PlacedContact& one) { return one.position_m; });
  add_point_data<vtkUnsignedIntArray>(*cloud, "collider", contacts, [](const auto& one) { return one.collider; });
  add_point_data<vtkUnsignedIntArray>(*cloud, "triangle", contacts, [](const auto& one) { return one.triangle; });
  add_point_data<vtkIntArray>(*cloud, "actuator", contacts, [](const auto& one) { return one.actuator; });
  add_point_data<vtkIntArray>(*cloud, "side", contacts, [](const auto& one) { return one.side; });
  add_point_data<vtkDoubleArray>(*cloud, "speed_m_per_s", contacts, [](const auto& one) { return one.speed_m_per_s; });
  add_point_data<vtkDoubleArray>(*cloud, "depth_m", contacts, [](const auto& one) { return one.depth_m; });
  add_point_data<vtkDoubleArray>(*cloud, "time_s", contacts, [](const auto& one) { return one.time_s; });
  return cloud;
}

}  // namespace

ParaviewSeries::ParaviewSeries(std::filesystem::path stem, Overwrite overwrite, const Subject& subject)
    : stem_(std::move(stem)), overwrite_(overwrite), folder_(stem_, overwrite), subject_(subject) {
  refuse_overwrite(stem_.string() + ".pvd", overwrite);
  const std::size_t count = subject.avatar.triangles.size();
  actuator_of_triangle_.reserve(count);
  for (std::size_t triangle = 0; triangle < count; ++triangle)
    actuator_of_triangle_.push_back(subject.actuator_at(static_cast<std::uint32_t>(triangle), 1.0 / 3, 1.0 / 3));
}

void ParaviewSeries::write(const SeriesStep& step) {
  const Avatar& avatar = subject_.avatar;
  vtkNew<vtkPolyData> skin;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  skin_reference(avatar, *step.pose, glm::dvec3(0), skin_m_);
  for (const glm::dvec3& point : skin_m_) points->InsertNextPoint(point.x, point.y, point.z);
  skin->SetPoints(points);
  vtkNew<vtkCellArray> triangles;
  for (const glm::uvec3& corner : avatar.triangles) {
    const std::array<vtkIdType, 3> ids = {corner.x, corner.y, corner.z};
    triangles->InsertNextCell(3, ids.data());
  }
  skin->SetPolys(triangles);

  const std::size_t count = avatar.triangles.size();
  auto actuator = new_array<vtkIntArray>("actuator", count);
  auto amplitude = new_array<vtkFloatArray>("amplitude", count);
  auto contacts = new_array<vtkIntArray>("contacts", count);
  for (std::size_t triangle = 0; triangle < count; ++triangle) {
    const auto id = static_cast<vtkIdType>(triangle);
    const std::uint16_t number = actuator_of_triangle_[triangle];
    actuator->SetValue(id, number);
    amplitude->SetValue(id, number == 0 ? 0 : step.amplitude[number - 1U]);
    contacts->SetValue(id, 0);
  }
  for (const PlacedContact& contact : step.contacts)
    contacts->SetValue(contact.triangle, contacts->GetValue(contact.triangle) + 1);
  skin->GetCellData()->AddArray(actuator);
  skin->GetCellData()->AddArray(amplitude);
  skin->GetCellData()->AddArray(contacts);
  skin->GetCellData()->SetActiveScalars("amplitude");

  vtkNew<vtkFloatArray> texture;
  texture->SetName("texture_coordinate");
  texture->SetNumberOfComponents(2);
  for (const glm::vec2& at : avatar.texture_coordinate) {
    // glTF counts v from the picture's top.
    const std::array<float, 2> value = {at.x, 1 - at.y};
    texture->InsertNextTypedTuple(value.data());
  }
  skin->GetPointData()->SetTCoords(texture);

  auto names = new_array<vtkStringArray>("actuator_name", subject_.map.names.size());
  for (std::size_t i = 0; i < subject_.map.names.size(); ++i)
    names->SetValue(static_cast<vtkIdType>(i), subject_.map.names[i]);
  if (!subject_.map.names.empty()) skin->GetFieldData()->AddArray(names);
  write_part("avatar", *skin, step.time_s);

  write_part("colliders", *collider_cloud(step.colliders), step.time_s);
  write_part("contacts", *contact_cloud(step.contacts), step.time_s);
  times_s_.push_back(step.time_s);
}

void ParaviewSeries::write_part(const char* part, vtkPolyData& data, double time_s) {
  auto time = new_array<vtkDoubleArray>("TimeValue", 1);  // the name that VTK's readers know
  time->SetValue(0, time_s);
  data.GetFieldData()->AddArray(time);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  // ParaView 5.11 refuses data that is appended at the end of the file.
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->WriteToOutputStringOn();
  const std::filesystem::path path = folder_.path() / file_name(part, times_s_.size());
  if (writer->Write() == 0)
    throw Error(path.string(), "VTK could not write it", "make sure that there is enough memory");
  OutputFile file(path, Overwrite::kAllow);
  file.write(writer->GetOutputString());
  file.commit();
}

std::string ParaviewSeries::collection() const {
  const std::string folder = html_text(stem_.filename().string());
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t step = 0; step < times_s_.size(); ++step)
    for (std::size_t part = 0; part < kParts.size(); ++part)
      text += fmt::format("    <DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}/{}\"/>\n", times_s_[step],
                          part, kParts[part], folder, file_name(kParts[part], step));
  return text + "  </Collection>\n</VTKFile>\n";
}

void ParaviewSeries::commit() {
  const std::string list = stem_.string() + ".pvd";
  std::filesystem::remove(list);  // a list of what is about to go
  folder_.commit(is_one_of_ours);
  OutputFile file(list, overwrite_);
  file.write(collection());
  file.commit();
}

}  // namespace vestige::plot
