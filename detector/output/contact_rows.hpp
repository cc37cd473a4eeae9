#pragma once

#include <optional>
#include <string>
#include <vector>

#include "detector/output/recorded_contacts.hpp"

namespace vestige {

inline constexpr const char* kContactsRemedy = "write it with 'vestige replay --contacts'";

/// What is wrong with a contact of a file.
struct ContactFault {
  const char* column;
  std::string cause;
  const char* remedy;
};

/// Returns the first fault, if there is one.
std::optional<ContactFault> fault_of(const RecordedContact& contact, const ContactLimits& limits);

std::vector<RecordedContact> read_contacts_csv(const std::filesystem::path& path, const ContactLimits& limits);
std::vector<RecordedContact> read_contacts_hdf5(const std::filesystem::path& path, const ContactLimits& limits);

}  // namespace vestige
