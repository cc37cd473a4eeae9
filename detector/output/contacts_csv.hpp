#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <string>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/files/output_file.hpp"

namespace vestige {

/// Writes `frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z`, one row for each contact.
/// collider is the id in the trace. x, y, z are world metres. Floats have the shortest form that reads back to the same
/// bits. Rows must carry all planes except speed.
class ContactsCsv {
 public:
  ContactsCsv(const std::filesystem::path& path, Overwrite overwrite);
  void write(const DetectorFrame& frame, const ContactRow& row, const std::vector<std::uint32_t>& collider_ids);
  void commit() { file_.commit(); }

 private:
  OutputFile file_;
  std::string text_;
};

/// One contact of a contacts CSV: the part that a comparison with another run, or a drawing, needs.
struct RecordedContact {
  std::uint64_t frame = 0;
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;
  float t = 0;
  glm::dvec2 barycentric = glm::dvec2(0);  ///< weights of the triangle's second and third vertex
  std::uint16_t actuator = 0;
};

/// The numbers of triangles, actuators and frames that the contacts of a CSV can refer to.
struct ContactLimits {
  std::size_t triangles = std::numeric_limits<std::uint32_t>::max();
  std::size_t actuators = std::numeric_limits<std::uint16_t>::max();
  std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
};

/// Reads a file of `ContactsCsv`, with rows in any order, and returns the contacts ordered by frame and collider.
/// Throws `Error` with file and line, also if a contact refers to something that does not exist.
std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits = {});

}  // namespace vestige
