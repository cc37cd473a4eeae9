#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// A glTF's JSON, cut into its parts as text. The parts are parsed one at a time, because a tree of all of them would
/// be ten times as large as the text.
struct Outline {
  std::map<std::string, std::string_view, std::less<>> properties;  ///< properties of the document that are not lists
  std::map<std::string, std::vector<std::string_view>, std::less<>> lists;  ///< elements of the document's lists
  std::string_view extensions;  ///< the document's, whole; empty if it has none
};

/// Checks the grammar of JSON (RFC 8259) from end to end, and cuts the text. Leaves out lists that are never read
/// (materials, textures, images, texture samplers, cameras) and the document's extras; of the document's extensions,
/// only the grammar is checked. Fails with the byte offset, also on nesting deeper than any glTF's.
Outline outline_json(std::string_view text, const Report& report);

/// Returns an element of the document's list `list`, or a property of that name that is not a list, as text. Leaves out
/// the parts that are never read: extras, references to what `outline_json` leaves out, and extensions, except where
/// one may say that geometry is compressed. Fails at `path` if an object that is read has a property twice.
/// Precondition: `outline_json` returned this element.
///
/// The `uri` of a buffer that holds its data becomes "data:", and `find_data_uri` returns it. Such a uri may be most of
/// the file, and need not be parsed.
std::string reduce_element(std::string_view element, std::string_view list, std::string_view path,
                           const Report& report);

/// Precondition: `reduce_element` shortened the uri of this element.
std::string_view find_data_uri(std::string_view element, const Report& report);

}  // namespace vestige::gltf
