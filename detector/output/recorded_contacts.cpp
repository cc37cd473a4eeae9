#include "detector/output/recorded_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "detector/output/contact_rows.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_reader.hpp"

namespace vestige {

std::optional<ContactFault> fault_of(const RecordedContact& contact, const ContactLimits& limits) {
  const glm::dvec2& weights = contact.barycentric;
  const auto beyond = [](const char* what, std::uint64_t number, std::uint64_t count) {
    return ContactFault{what, fmt::format("refers to {} {}, but there are only {}", what, number, count),
                        "use the contacts of this trace, avatar and map"};
  };
  if (!(contact.t >= 0 && contact.t <= 1)) return ContactFault{"t", "t must be from 0 to 1", kContactsRemedy};
  if (!(weights.x >= 0 && weights.x <= 1 && weights.y >= 0 && weights.y <= 1))
    return ContactFault{"u", "u and v must be weights from 0 to 1", kContactsRemedy};
  if (contact.frame >= limits.frames) return beyond("frame", contact.frame, limits.frames);
  if (contact.triangle >= limits.triangles) return beyond("triangle", contact.triangle, limits.triangles);
  if (contact.actuator > limits.actuators) return beyond("actuator", contact.actuator, limits.actuators);
  return {};
}

std::vector<RecordedContact> read_contacts(const std::filesystem::path& path, const ContactLimits& limits) {
  std::vector<RecordedContact> contacts =
      is_hdf5(path) ? read_contacts_hdf5(path, limits) : read_contacts_csv(path, limits);
  const auto place = [](const RecordedContact& contact) { return std::pair(contact.frame, contact.collider); };
  std::ranges::sort(contacts, {}, place);
  const auto twice = std::ranges::adjacent_find(contacts, {}, place);
  if (twice != contacts.end())
    throw Error(path.string(), fmt::format("collider {} has two contacts in frame {}", twice->collider, twice->frame),
                kContactsRemedy);
  return contacts;
}

}  // namespace vestige
