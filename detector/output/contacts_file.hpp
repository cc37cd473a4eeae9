#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"
#include "traces/files/output_file.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What columns a file of contacts has beside those that all have.
struct OptionalColumns {
  ColliderShape shape = ColliderShape::kPoints;  ///< kSpheres: `depth`
  bool has_avatars = false;                      ///< `avatar`, of a trace of several people
};

/// A file of contacts, which `read_contacts` reads. It is complete or absent: without `commit` it leaves nothing
/// behind. Every function throws `Error` with the file's name.
class ContactsFile {
 public:
  ContactsFile() = default;
  virtual ~ContactsFile() = default;
  ContactsFile(const ContactsFile&) = delete;
  ContactsFile& operator=(const ContactsFile&) = delete;

  /// Writes the contacts of a frame in the order of the colliders. `avatar` counts people from 1. `collider_ids` are
  /// those in the trace. The row must carry all planes except speed and pressure; depth only if the file has it.
  virtual void write(std::uint16_t avatar, const DetectorFrame& frame, const ContactRow& row,
                     const std::vector<std::uint32_t>& collider_ids) = 0;
  virtual void commit() = 0;
};

/// Writes HDF5 if the name ends in .h5 or .hdf5, otherwise CSV. "-" is standard output, as CSV.
///
/// CSV has the header `frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z`, and one row for
/// each contact; if some colliders are spheres, also `depth`, and in a trace of several people at the end `avatar`,
/// from 1 on. x, y, z are world metres. Floats have the shortest form that reads back to the same bits. HDF5 has a list
/// for each column of the CSV, with the same name and values to the bit; `attributes`, which CSV does without, become
/// texts of the whole file. Throws `Error` if the library of HDF5 is not installed.
std::unique_ptr<ContactsFile> make_contacts_file(const std::filesystem::path& path, Overwrite overwrite,
                                                 const std::map<std::string, std::string>& attributes,
                                                 OptionalColumns columns);

}  // namespace vestige
