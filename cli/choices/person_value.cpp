#include "cli/choices/person_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <system_error>

#include "traces/base/error.hpp"
#include "traces/scene/people.hpp"

namespace vestige::cli {

namespace {

/// Returns whether a value names no person where it looks as if it did: "1.5=FILE", or "K=FILE" as help has it.
bool misnames_person(const std::string& text) {
  const std::string before = text.substr(0, text.find('='));
  std::error_code ignored;
  return before.size() < text.size() && !before.empty() &&
         (before == "K" || before.find_first_not_of("0123456789.") == std::string::npos) &&
         !std::filesystem::exists(text, ignored);
}

}  // namespace

PersonValue parse_person_value(const std::string& text) {
  const std::size_t sign = std::min(text.find('='), text.size());
  if (sign == 0 || sign == text.size() || text.find_first_not_of("0123456789") != sign) return {std::nullopt, text};
  std::size_t number = 0;
  const auto read = std::from_chars(text.data(), text.data() + sign, number);
  constexpr std::size_t kNobodyThere = std::numeric_limits<std::size_t>::max() - 1;
  return {read.ec == std::errc() && number > 0 ? number - 1 : kNobodyThere, text.substr(sign + 1),
          text.substr(0, sign)};
}

std::vector<PersonValue> parse_person_values(const PersonFlag& flag, const std::vector<std::string>& texts) {
  std::vector<PersonValue> values;
  std::set<std::size_t> people;
  for (const std::string& text : texts) {
    const PersonValue& value = values.emplace_back(parse_person_value(text));
    if (value.person && value.number.find_first_not_of('0') == std::string::npos)
      throw UsageError(flag.name, fmt::format("'{}': people count from 1", text),
                       fmt::format("write for example {} 2={}", flag.name, flag.example));
    if (!value.person && misnames_person(text))
      throw UsageError(flag.name, fmt::format("'{}': a person's number is expected before '='", text),
                       fmt::format("write for example {} 2={}", flag.name, flag.example));
    if (value.value.empty())
      throw UsageError(flag.name, fmt::format("'{}' names no {}", text, flag.noun),
                       fmt::format("write for example {} {}", flag.name, flag.example));
    const std::size_t person = value.person.value_or(0);
    if (!people.insert(person).second)
      throw UsageError(flag.name, fmt::format("person {} gets two {}s", person + 1, flag.noun),
                       "leave one of them out");
  }
  return values;
}

std::size_t person_of(const PersonValue& value, const PersonFlag& flag, std::size_t people, const std::string& name) {
  if (!value.person && people > 1)
    throw UsageError(flag.name, fmt::format("'{}': {} holds {}", value.value, name, count_of_people(people)),
                     fmt::format("say whose {} it is: {} 1={}", flag.noun, flag.name, flag.example));
  const std::size_t person = value.person.value_or(0);
  if (person >= people)
    throw UsageError(
        flag.name,
        fmt::format("there is no person {} in {}, which holds {}", value.number, name, count_of_people(people)),
        "choose one who is there");
  return person;
}

std::string numbered_path(std::filesystem::path path, std::size_t person) {
  const std::string name = fmt::format("{}.{}{}", path.stem().string(), person + 1, path.extension().string());
  return path.replace_filename(name).string();
}

bool is_pipe(const std::string& path) {
  std::error_code missing;
  return path == "-" || (std::filesystem::exists(path, missing) && !std::filesystem::is_regular_file(path, missing));
}

}  // namespace vestige::cli
