#pragma once

#include <filesystem>
#include <vector>

#include "detector/output/contacts_file.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "traces/hdf5/hdf5_writer.hpp"

namespace vestige {

/// Returns the columns of contacts in HDF5: those of the CSV, in its order.
std::vector<Hdf5Column::Description> contact_columns(OptionalColumns optional);

/// Contacts in an HDF5 file, a list for each column of the CSV. Throws `Error` with the file's name.
class ContactColumns {
 public:
  /// `where` is a file or a group. `path` names the file in errors.
  ContactColumns(hid_t where, const std::filesystem::path& path, OptionalColumns optional);
  /// The contact has a depth if the file has.
  void append(const RecordedContact& contact);
  /// Writes what is left.
  void close();

 private:
  OptionalColumns optional_;
  std::vector<Hdf5Column> columns_;
};

}  // namespace vestige
