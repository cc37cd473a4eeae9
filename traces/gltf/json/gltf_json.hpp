#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "traces/gltf/json/gltf_scan.hpp"

namespace vestige::gltf {

/// The JSON of a glTF; only one element at a time is a tree. Skips the parts that detection never reads: extras,
/// materials, textures, images, texture samplers, cameras, references to them, and most extensions. So a missing or
/// broken image does not affect the geometry.
class Json {
 public:
  /// Checks the whole grammar, the top level (asset, scene, the names of extensions), and which lists exist. Keeps a
  /// reference to `text`. Fails on anything that is not JSON, is nested deeper than any glTF is, or has another
  /// version.
  Json(std::string_view text, Report& report);

  /// The top level without the lists.
  const nlohmann::json& head() const { return head_; }

  /// The document's extensions as text, unchecked but for the grammar; empty if it has none.
  std::string_view extensions() const { return outline_.extensions; }

  bool has(std::string_view list) const { return outline_.lists.contains(list); }

  /// Returns the number of elements of a list such as "nodes", 0 if the list does not exist.
  std::size_t count(std::string_view list) const;

  /// Returns one element of a list, checked by `check_element`. Precondition: index < count(list).
  nlohmann::json element(std::string_view list, std::size_t index, Report& report) const;

  /// Returns a member of the `extras` of one element, unchecked; null if it has none, or one that is no plain value.
  /// Precondition: index < count(list).
  nlohmann::json extra(std::string_view list, std::size_t index, std::string_view name) const;

  /// Returns the full `uri` of a buffer. `buffer` is `element("buffers", index)`, in which a data URI is shortened to
  /// "data:".
  std::string_view buffer_uri(std::size_t index, const nlohmann::json& buffer, const Report& report) const;

 private:
  Outline outline_;
  nlohmann::json head_;
};

/// Both functions check against the glTF 2.0 schema (§5): required properties, types, ranges, array lengths, allowed
/// words, and that every index refers to something that exists. They warn of unknown properties and of harmless empty
/// lists. Integers written as 3.0 become 3, with a warning.
void check_head(nlohmann::json& head, const Outline& outline, Report& report);
void check_element(nlohmann::json& element, std::string_view list, std::size_t index, const Outline& outline,
                   Report& report);

}  // namespace vestige::gltf
