#include "detector/output/recorded_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "detector/output/contact_rows.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_reader.hpp"

namespace vestige {

RecordedContact recorded(std::uint16_t avatar, const DetectorFrame& frame, const Contact& contact,
                         std::uint32_t collider) {
  return {.frame = frame.index,
          .time_s = frame.time_s,
          .collider = collider,
          .triangle = contact.triangle,
          .t = contact.t,
          .barycentric = contact.barycentric,
          .texture_coordinate = contact.texture_coordinate,
          .actuator = contact.actuator,
          .side = contact.side,
          .position_m = frame.origin_m + contact.position,
          .depth_m = contact.depth_m,
          .avatar = avatar};
}

std::optional<ContactFault> fault_of(const RecordedContact& contact, const ContactLimits& limits) {
  const glm::dvec2& weights = contact.barycentric;
  const glm::dvec2& texture = contact.texture_coordinate;
  const glm::dvec3& place = contact.position_m;
  const std::pair<const char*, double> finite[] = {{"time_s", contact.time_s},
                                                   {"texture_u", texture.x},
                                                   {"texture_v", texture.y},
                                                   {"x", place.x},
                                                   {"y", place.y},
                                                   {"z", place.z},
                                                   {"depth", contact.depth_m.value_or(0)}};
  for (const auto& [column, number] : finite)
    if (!std::isfinite(number))
      return ContactFault{column, fmt::format("{} must be finite, and is {}", column, number), kContactsRemedy};
  const auto beyond = [](const char* what, std::uint64_t number, std::uint64_t count, const std::string& who) {
    return ContactFault{what, fmt::format("refers to {} {}, but {} only {}", what, number, who, count),
                        "use the contacts of this trace, avatar and map"};
  };
  if (!(contact.t >= 0 && contact.t <= 1)) return ContactFault{"t", "t must be from 0 to 1", kContactsRemedy};
  for (const auto& [column, weight] : {std::pair("u", weights.x), std::pair("v", weights.y)})
    if (!(weight >= 0 && weight <= 1))
      return ContactFault{column, "u and v must be weights from 0 to 1", kContactsRemedy};
  if (contact.depth_m.value_or(0) < 0) return ContactFault{"depth", "depth must not be negative", kContactsRemedy};
  if (contact.side < -1 || contact.side > 1) return ContactFault{"side", "side must be -1, 0 or 1", kContactsRemedy};
  if (contact.avatar == 0) return ContactFault{"avatar", "avatar must be from 1 on", kContactsRemedy};
  if (contact.frame >= limits.frames) return beyond("frame", contact.frame, limits.frames, "there are");
  if (contact.avatar > limits.people.size()) return beyond("avatar", contact.avatar, limits.people.size(), "there are");
  const PersonLimits& person = limits.people[contact.avatar - 1U];
  const auto who = [&] {
    return limits.people.size() == 1 ? "there are" : fmt::format("person {} has", contact.avatar);
  };
  if (contact.triangle >= person.triangles) return beyond("triangle", contact.triangle, person.triangles, who());
  if (contact.actuator > person.actuators) return beyond("actuator", contact.actuator, person.actuators, who());
  return {};
}

void require_avatars(const std::filesystem::path& path, const OptionalColumns& columns, const ContactLimits& limits) {
  if (columns.has_avatars || limits.people.size() <= 1) return;
  throw Error(path.string(),
              fmt::format("has contacts of a trace of one person: they do not say whom of the {} people they touch",
                          limits.people.size()),
              "use the contacts of this trace: vestige replay TRACE --contacts FILE");
}

std::vector<RecordedContact> read_contacts(const std::filesystem::path& path, const ContactLimits& limits) {
  std::vector<RecordedContact> contacts =
      is_hdf5(path) ? read_contacts_hdf5(path, limits) : read_contacts_csv(path, limits);
  const auto place = [](const RecordedContact& contact) {
    return std::tuple(contact.frame, contact.avatar, contact.collider);
  };
  std::ranges::sort(contacts, {}, place);
  const auto twice = std::ranges::adjacent_find(contacts, {}, place);
  if (twice != contacts.end())
    throw Error(path.string(),
                fmt::format("collider {} has two contacts in frame {}{}", twice->collider, twice->frame,
                            limits.people.size() > 1 ? fmt::format(" with avatar {}", twice->avatar) : ""),
                kContactsRemedy);
  return contacts;
}

}  // namespace vestige
