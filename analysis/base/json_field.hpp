#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vestige {

/// Reads a JSON file. Throws `Error` with the file, and with the byte at which the file stops being JSON. `remedy` is
/// used as in `JsonField`.
nlohmann::json read_json(const std::filesystem::path& file, std::string_view remedy);

/// A value of a result file and the path to it. Functions throw `Error` with file, field and remedy if the value is not
/// what is asked for. Keeps references to document, file name and remedy.
class JsonField {
 public:
  JsonField(const nlohmann::json& document, const std::filesystem::path& file, std::string_view remedy)
      : value_(document), file_(file), remedy_(remedy) {}

  [[noreturn]] void refuse(std::string_view cause) const;
  const nlohmann::json& value() const { return value_; }
  /// Returns whether the value is an object with this member, and the member is not null.
  bool has(const char* key) const;
  JsonField at(const char* key) const;
  JsonField at(std::size_t index) const;
  /// Returns the length of a list. Throws if the list is empty.
  std::size_t count() const;
  double within(double least, double most) const;
  std::string text() const;
  bool flag() const;  ///< true or false

 private:
  JsonField(const JsonField& parent, const nlohmann::json& value, std::string name)
      : value_(value), name_(std::move(name)), file_(parent.file_), remedy_(parent.remedy_) {}

  const nlohmann::json& value_;
  std::string name_;  ///< empty for the document itself
  const std::filesystem::path& file_;
  std::string_view remedy_;
};

/// Returns the texts and numbers of those members that `field` has, each followed by its words, separated by ", ".
std::string phrase(const JsonField& field, std::initializer_list<std::pair<const char*, const char*>> keys);

/// Returns the "commit" of a result file, shortened, with " (changed)" if files had been changed since.
std::string commit_of(const JsonField& document);

}  // namespace vestige
