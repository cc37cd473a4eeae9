#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vestige::gltf {

/// The findings about one glTF file: either a failure, or a list of oddities.
class Report {
 public:
  explicit Report(std::string_view name) : name_(name) {}

  /// Throws `Error` at "NAME: PATH". `path` is a JSON path such as "accessors[3].bufferView", or a byte offset; empty
  /// for the file as a whole. An empty remedy stands for the usual one for a broken file.
  [[noreturn]] void fail(std::string_view path, std::string_view cause, std::string_view remedy = {}) const;

  /// Notes something odd but harmless. The same `what` at many places becomes one sentence that names the first place.
  void warn(std::string_view path, std::string_view what);

  /// Returns one sentence for each kind of oddity, in the order in which they were found.
  std::vector<std::string> warnings() const;

  const std::string& name() const { return name_; }

 private:
  struct Oddity {
    std::string first_path;
    std::string what;
    std::size_t count = 1;
  };

  std::string name_;
  std::vector<Oddity> oddities_;
};

}  // namespace vestige::gltf
