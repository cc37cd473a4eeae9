#include "detector/output/contacts_file.hpp"

#include "detector/output/contact_rows.hpp"
#include "traces/hdf5/hdf5_reader.hpp"

namespace vestige {

std::unique_ptr<ContactsFile> make_contacts_file(const std::filesystem::path& path, Overwrite overwrite,
                                                 const std::map<std::string, std::string>& attributes,
                                                 OptionalColumns columns) {
  if (has_hdf5_name(path)) return make_contacts_hdf5(path, overwrite, attributes, columns);
  return make_contacts_csv(path, overwrite, columns);
}

}  // namespace vestige
