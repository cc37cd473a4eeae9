#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "traces/gltf/json/gltf_scan.hpp"

namespace vestige::gltf {

/// A glTF's JSON, of which one element is a tree at a time. What detection never reads is dropped unseen: extras,
/// materials, textures, images, texture samplers, cameras, references to them, and most extensions. So a missing or
/// broken image cannot stop the geometry.
class Json {
 public:
  /// Checks the grammar of all of it, what stands at the top (asset, scene, the names of extensions), and which lists
  /// there are. Refers to `text`. Fails on anything that is not JSON, is nested deeper than any glTF is, or is of
  /// another version.
  Json(std::string_view text, Report& report);

  /// What stands at the top, without the lists.
  const nlohmann::json& head() const { return head_; }

  bool has(std::string_view list) const { return outline_.lists.contains(list); }

  /// The elements of a list such as "nodes", 0 where there is none.
  std::size_t count(std::string_view list) const;

  /// One of them, checked by `check_element`. Precondition: index < count(list).
  nlohmann::json element(std::string_view list, std::size_t index, Report& report) const;

  /// The `uri` of a buffer, which is `element("buffers", index)`: there, one that holds data is shortened to "data:".
  std::string_view buffer_uri(std::size_t index, const nlohmann::json& buffer, const Report& report) const;

 private:
  Outline outline_;
  nlohmann::json head_;
};

/// Both check against the glTF 2.0 schema (§5): required properties, types, ranges, array lengths, allowed words, and
/// that every index refers to something that exists. Unknown properties and empty lists that do no harm are warned of.
/// Whole numbers written as 3.0 become 3, with a warning.
void check_head(nlohmann::json& head, const Outline& outline, Report& report);
void check_element(nlohmann::json& element, std::string_view list, std::size_t index, const Outline& outline,
                   Report& report);

}  // namespace vestige::gltf
