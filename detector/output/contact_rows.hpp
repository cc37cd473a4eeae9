#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "detector/output/contacts_file.hpp"
#include "detector/output/recorded_contacts.hpp"

namespace vestige {

inline constexpr const char* kContactsRemedy = "write it with 'vestige replay --contacts'";

/// Returns what files say of a contact of `frame`, by the collider with this id on this avatar.
RecordedContact recorded(std::uint16_t avatar, const DetectorFrame& frame, const Contact& contact,
                         std::uint32_t collider);

/// What is wrong with a contact of a file.
struct ContactFault {
  const char* column;
  std::string cause;
  const char* remedy;
};

/// Returns the first fault, if there is one.
std::optional<ContactFault> fault_of(const RecordedContact& contact, const ContactLimits& limits);

/// Throws `Error` if a file without avatars is read where there are several people.
void require_avatars(const std::filesystem::path& path, const OptionalColumns& columns, const ContactLimits& limits);

// The two formats, for `make_contacts_file` and `read_contacts`.
std::unique_ptr<ContactsFile> make_contacts_csv(const std::filesystem::path& path, Overwrite overwrite,
                                                OptionalColumns columns);
std::unique_ptr<ContactsFile> make_contacts_hdf5(const std::filesystem::path& path, Overwrite overwrite,
                                                 const std::map<std::string, std::string>& attributes,
                                                 OptionalColumns columns);
std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits);
std::vector<RecordedContact> read_contacts_hdf5(const std::filesystem::path& path, const ContactLimits& limits);

}  // namespace vestige
