#include "analysis/viz/seen.hpp"

#include <fmt/format.h>

namespace vestige {

std::vector<const Avatar*> avatars_of(std::span<const MappedPerson> people) {
  std::vector<const Avatar*> avatars;
  for (const MappedPerson& person : people) avatars.push_back(&person.avatar);
  return avatars;
}

std::vector<std::string> viz_actuator_names(std::span<const MappedPerson> people) {
  std::vector<std::string> names;
  for (std::size_t person = 0; person < people.size(); ++person)
    for (const std::string& name : people[person].map.names)
      names.push_back(person == 0 ? name : fmt::format("{}/{}", person + 1, name));
  return names;
}

}  // namespace vestige
