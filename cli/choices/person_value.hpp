#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vestige::cli {

/// A value of a flag that may say whose it is: VALUE, or K=VALUE for person K, who counts from 1.
struct PersonValue {
  std::optional<std::size_t> person;  ///< from 0 on; none if the value does not say it
  std::string value;
  std::string number = {};  ///< of the person, as written
};

/// A flag that takes such values, for messages.
struct PersonFlag {
  const char* name;     ///< "--map"
  const char* noun;     ///< "map"
  const char* example;  ///< what may stand in the place of VALUE: "FILE.png"
};

/// Splits one value.
PersonValue parse_person_value(const std::string& text);

/// Reads all values of a flag. Throws `UsageError` for person 0, for what is no number where one is expected, for an
/// empty value, and if a person gets two.
std::vector<PersonValue> parse_person_values(const PersonFlag& flag, const std::vector<std::string>& texts);

/// Returns the person, counted from 0, of a scene with so many `people`, whose value this is. Throws `UsageError` for a
/// person who is not there, and if a scene of several people leaves open who is meant. `name` is that of the trace, or
/// of the live sources.
std::size_t person_of(const PersonValue& value, const PersonFlag& flag, std::size_t people, const std::string& name);

/// Returns the path with the person's number in it: OUT.2.csv for the second. `person` counts from 0.
std::string numbered_path(std::filesystem::path path, std::size_t person);

/// Whether a result goes to standard output, a pipe or a device, which take only one.
bool is_pipe(const std::string& path);

}  // namespace vestige::cli
