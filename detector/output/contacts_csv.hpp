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

/// Writes `frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z`, one row a contact. collider
/// is the id in the trace; x, y, z are world metres; floats in the shortest form that reads back to the same bits. Rows
/// must carry all planes but speed.
class ContactsCsv {
 public:
  ContactsCsv(const std::filesystem::path& path, Overwrite overwrite);
  void write(const Frame& frame, const ContactRow& row, const std::vector<std::uint32_t>& collider_ids);
  void commit() { file_.commit(); }

 private:
  OutputFile file_;
  std::string text_;
};

/// What a contacts CSV says of one contact, as far as another run is compared with it or it is drawn.
struct RecordedContact {
  std::uint64_t frame = 0;
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;
  float t = 0;
  glm::dvec2 barycentric = glm::dvec2(0);  ///< weights of the triangle's second and third vertex
  std::uint16_t actuator = 0;
};

/// What the contacts of a CSV can refer to.
struct ContactLimits {
  std::size_t triangles = std::numeric_limits<std::uint32_t>::max();
  std::size_t actuators = std::numeric_limits<std::uint16_t>::max();
  std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
};

/// Reads back what `ContactsCsv` wrote, whatever the order of its rows, ordered by frame and collider. Throws `Error`
/// naming file and line, also for a contact that refers to what is not there.
std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits = {});

}  // namespace vestige
