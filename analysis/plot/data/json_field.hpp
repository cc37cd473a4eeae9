#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vestige::plot {

/// Throws `Error` naming the file, and the byte where it is no JSON; `remedy` as for `JsonField`.
nlohmann::json read_json(const std::filesystem::path& file, std::string_view remedy);

/// A value of a result file and the way to it. Every function throws `Error` naming file and field where something else
/// is found than is asked for. Refers to document, file name and remedy.
class JsonField {
 public:
  JsonField(const nlohmann::json& document, const std::filesystem::path& file, std::string_view remedy)
      : value_(document), file_(file), remedy_(remedy) {}

  [[noreturn]] void refuse(std::string_view cause) const;
  const nlohmann::json& value() const { return value_; }
  /// Whether it is an object with this member, and that is not null.
  bool has(const char* key) const;
  JsonField at(const char* key) const;
  JsonField at(std::size_t index) const;
  /// Of a list, which may not be empty.
  std::size_t count() const;
  double within(double least, double most) const;
  std::string text() const;

 private:
  JsonField(const JsonField& parent, const nlohmann::json& value, std::string name)
      : value_(value), name_(std::move(name)), file_(parent.file_), remedy_(parent.remedy_) {}

  const nlohmann::json& value_;
  std::string name_;  ///< empty: the document
  const std::filesystem::path& file_;
  std::string_view remedy_;
};

/// The texts and numbers of `field`'s members, where they are there, with the words behind them.
std::string phrase(const JsonField& field, std::initializer_list<std::pair<const char*, const char*>> keys);

/// "commit" of a result file, shortened, and whether files had been changed since.
std::string commit_of(const JsonField& document);

}  // namespace vestige::plot
