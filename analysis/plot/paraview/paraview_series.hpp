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

/// A contact in world coordinates.
struct PlacedContact {
  double time_s = 0;
  glm::dvec3 position_m = glm::dvec3(0);
  std::uint32_t collider = 0;  ///< the collider's id
  std::uint32_t triangle = 0;
  std::uint16_t actuator = 0;  ///< 0: skin that no actuator covers
  std::int8_t side = 0;        ///< +1 entering, -1 leaving, 0 coplanar
  double speed_m_per_s = 0;
  double depth_m = 0;  ///< 0 for points
};

/// One time step. Contacts and amplitudes are those since the previous step.
struct SeriesStep {
  double time_s = 0;
  const Pose* pose = nullptr;
  std::span<const float> amplitude;  ///< 0 … 1, one for each actuator of the map
  std::span<const ColliderSample> colliders;
  std::span<const PlacedContact> contacts;
};

/// A time series that ParaView opens. STEM.pvd lists the files of the folder STEM. Each step has three files (VTK XML
/// PolyData, zlib):
///   avatar_NNNNNN.vtp     the skin, world metres; cell data actuator (at the texel under each triangle's middle, or
///                         0), amplitude (0 … 1, of that actuator), contacts (in this step); texture coordinates with
///                         v upwards, as in VTK; field data actuator_name
///   colliders_NNNNNN.vtp  a point for each collider; point data collider (id), radius_m (0: a point)
///   contacts_NNNNNN.vtp   a point for each contact; point data collider, triangle, actuator, side,
///                         speed_m_per_s, depth_m, time_s
/// Holds one step in memory. Without `commit`, no file remains.
///
/// Functions throw `Error` with the file's name if the file exists (with `Overwrite::kRefuse`), if the folder does not
/// exist, or if the disk is full.
class ParaviewSeries {
 public:
  /// `subject` must outlive this object. `stem` is without .pvd.
  ParaviewSeries(std::filesystem::path stem, Overwrite overwrite, const Subject& subject);

  /// Writes a step. Times must rise.
  void write(const SeriesStep& step);
  /// Moves the files into place. The list is written last, so that it names only files that exist.
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
