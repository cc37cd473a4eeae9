#pragma once

#include <filesystem>
#include <vector>

#include "detector/output/recorded_contacts.hpp"
#include "traces/hdf5/hdf5_writer.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Returns the columns of contacts in HDF5: those of the CSV, in its order.
std::vector<Hdf5Column::Description> contact_columns(ColliderShape shape);

/// Contacts in an HDF5 file, a list for each column of the CSV. Throws `Error` with the file's name.
class ContactColumns {
 public:
  /// `where` is a file or a group. `path` names the file in errors.
  ContactColumns(hid_t where, const std::filesystem::path& path, ColliderShape shape);
  /// The contact has a depth if the colliders are spheres.
  void append(const RecordedContact& contact);
  /// Writes what is left.
  void close();

 private:
  std::vector<Hdf5Column> columns_;
};

}  // namespace vestige
