#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/output_file.hpp"

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

/// What a contacts CSV says of one contact, as far as another run is compared with it.
struct RecordedContact {
  std::uint64_t frame = 0;
  std::uint32_t collider = 0;
  std::uint32_t triangle = 0;
  float t = 0;
  std::uint16_t actuator = 0;
};

/// Reads back what `ContactsCsv` wrote. Throws `Error` naming file and line.
std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path);

}  // namespace vestige
