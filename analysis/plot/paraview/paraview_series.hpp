#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/base/growing_folder.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "traces/files/output_file.hpp"
#include "traces/scene/trace.hpp"

class vtkPolyData;

namespace vestige::plot {

/// A contact in the world.
struct PlacedContact {
  double time_s = 0;
  glm::dvec3 position_m = glm::dvec3(0);
  std::uint32_t collider = 0;  ///< its id
  std::uint32_t triangle = 0;
  std::uint16_t actuator = 0;  ///< 0: skin that no actuator covers
  std::int8_t side = 0;        ///< +1 entering, -1 leaving, 0 coplanar
  double speed_m_per_s = 0;
};

/// One time step. Contacts and amplitudes are those since the step before.
struct SeriesStep {
  double time_s = 0;
  const Pose* pose = nullptr;
  std::span<const float> amplitude;  ///< 0 … 1, one for each actuator of the map
  std::span<const ColliderSample> colliders;
  std::span<const PlacedContact> contacts;
};

/// A time series that ParaView opens: STEM.pvd lists the files of the folder STEM, of which each step has three (VTK
/// XML PolyData, zlib):
///   avatar_NNNNNN.vtp     the skin, world metres; cell data actuator (by the texel under each triangle's middle, 0:
///   none),
///                         amplitude (0 … 1, of that actuator), contacts (in this step); texture coordinates with v
///                         upwards, as VTK has it; field data actuator_name
///   colliders_NNNNNN.vtp  a point for each collider; point data collider (id)
///   contacts_NNNNNN.vtp   a point for each contact; point data collider, triangle, actuator, side, speed_m_per_s,
///   time_s
/// Memory is that of one step. Without `commit` nothing is left behind.
///
/// Every function throws `Error` naming the file: it exists (and `Overwrite::kRefuse`), no such folder, disk full.
class ParaviewSeries {
 public:
  /// `subject` must stay. `stem`: without .pvd.
  ParaviewSeries(std::filesystem::path stem, Overwrite overwrite, const Subject& subject);

  /// Times must rise.
  void write(const SeriesStep& step);
  /// The list is written last, so that it names no file that is not there.
  void commit();

  std::size_t steps() const { return times_s_.size(); }

 private:
  void write_part(const char* part, vtkPolyData& data, double time_s);
  std::string collection() const;

  std::filesystem::path stem_;
  Overwrite overwrite_;
  GrowingFolder folder_;
  const Subject& subject_;
  std::vector<std::uint16_t> actuator_of_triangle_;
  std::vector<double> times_s_;
  std::vector<glm::dvec3> skin_m_;
};

}  // namespace vestige::plot
