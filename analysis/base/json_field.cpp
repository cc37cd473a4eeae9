#include "analysis/base/json_field.hpp"

#include <fmt/format.h>

#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

nlohmann::json read_json(const std::filesystem::path& file, std::string_view remedy) {
  try {
    return nlohmann::json::parse(read_text_file(file));
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(fmt::format("{}, byte {}", file.string(), error.byte), "is not JSON", remedy);
  } catch (const nlohmann::json::out_of_range&) {
    throw Error(file.string(), "holds a number beyond the largest double", remedy);
  }
}

void JsonField::refuse(std::string_view cause) const {
  throw Error(file_.string(), fmt::format("{} {}", name_.empty() ? "the document" : name_, cause), remedy_);
}

bool JsonField::has(const char* key) const {
  return value_.is_object() && value_.contains(key) && !value_.at(key).is_null();
}

JsonField JsonField::at(const char* key) const {
  const std::string full = name_.empty() ? key : fmt::format("{}.{}", name_, key);
  if (!value_.is_object() || !value_.contains(key))
    throw Error(file_.string(), fmt::format("the field {} is missing", full), remedy_);
  return {*this, value_.at(key), full};
}

JsonField JsonField::at(std::size_t index) const {
  return {*this, value_.at(index), fmt::format("{}[{}]", name_, index)};
}

std::size_t JsonField::count() const {
  if (!value_.is_array()) refuse("is not a list");
  if (value_.empty()) refuse("is empty");
  return value_.size();
}

double JsonField::within(double least, double most) const {
  if (!value_.is_number()) refuse("is not a number");
  const double number = value_.get<double>();
  if (!(number >= least && number <= most)) refuse(fmt::format("is {}, not within {} and {}", number, least, most));
  return number;
}

bool JsonField::flag() const {
  if (!value_.is_boolean()) refuse("is neither true nor false");
  return value_.get<bool>();
}

std::string JsonField::text() const {
  if (!value_.is_string()) refuse("is not a text");
  return value_.get<std::string>();
}

std::string phrase(const JsonField& field, std::initializer_list<std::pair<const char*, const char*>> keys) {
  std::string result;
  for (const auto& [key, words] : keys) {
    if (!field.has(key)) continue;
    const nlohmann::json& value = field.value().at(key);
    if (!value.is_string() && !value.is_number()) continue;
    const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    if (shown.empty()) continue;
    if (!result.empty()) result += ", ";
    result += shown + words;
  }
  return result;
}

std::string commit_of(const JsonField& document) {
  std::string commit = document.at("commit").text().substr(0, 10);
  if (document.has("dirty") && document.at("dirty").value() == true) commit += " (changed)";
  return commit;
}

}  // namespace vestige
