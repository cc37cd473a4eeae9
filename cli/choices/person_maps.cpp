#include "cli/choices/person_maps.hpp"

#include <utility>

#include "analysis/mapping/layouts.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

CLI::Option* add_maps_option(CLI::App& verb, std::vector<std::string>& maps, const std::string& group) {
  return verb
      .add_option("--map", maps,
                  "Use another actuator map than the trace's: of a trace of several people, that of person K; repeat "
                  "for more people")
      ->group(group)
      ->type_name("[K=]FILE.png|LAYOUT|none")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

std::vector<PersonValue> parse_maps(const std::vector<std::string>& texts, const PersonFlag& flag) {
  std::vector<PersonValue> maps = parse_person_values(flag, texts);
  for (const PersonValue& map : maps)
    if (map.value == "-")
      throw UsageError(flag.name, "a map cannot come from standard input", "name a file or a layout");
  return maps;
}

void add_map_files(const std::vector<PersonValue>& maps, std::vector<std::string>& inputs) {
  for (const PersonValue& map : maps) inputs.insert(inputs.end(), {map.value, sidecar_path(map.value).string()});
}

std::vector<std::string> map_warnings(const ActuatorMap& map, const TracedPerson& person, const SceneNames& names) {
  std::vector<std::string> warnings = map.warnings;
  std::string other = other_facing(person.avatar.facing, map.facing, names);
  if (!other.empty()) warnings.push_back(std::move(other));
  return warnings;
}

ActuatorMap read_map(const std::string& map, const TracedPerson& person, const std::string& trace,
                     Verbosity verbosity) {
  const ActuatorMapFiles files = read_map_files(person.avatar, map);
  if (files.png.empty()) return {};
  ActuatorMap read = parse_actuator_map(files, person.avatar, map);
  for (const std::string& warning : map_warnings(read, person, {trace, map})) warn(warning, verbosity);
  return read;
}

void use_maps(const std::vector<PersonValue>& maps, std::span<TracedPerson> people, const std::string& trace,
              Verbosity verbosity, const PersonFlag& flag) {
  for (const PersonValue& map : maps) {
    TracedPerson& person = people[person_of(map, flag, people.size(), trace)];
    person.map = read_map(map.value, person, trace, verbosity);
  }
}

}  // namespace vestige::cli
