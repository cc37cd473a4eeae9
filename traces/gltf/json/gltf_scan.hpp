#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// A glTF's JSON, cut into its parts as text: they are parsed one at a time, since a tree of all of them would be ten
/// times as large as the text.
struct Outline {
  std::map<std::string, std::string_view, std::less<>> properties;          ///< those of the document that are no list
  std::map<std::string, std::vector<std::string_view>, std::less<>> lists;  ///< the elements of those that are one
};

/// Checks the grammar of JSON (RFC 8259) from end to end and cuts it. Lists that are never read (materials, textures,
/// images, texture samplers, cameras) and the document's extras and extensions are left out. Fails naming the byte, and
/// on nesting deeper than any glTF's.
Outline outline_json(std::string_view text, const Report& report);

/// An element of the document's list `list`, or a property of that name that is no list, as text, without what is never
/// read in it: extras, references to what `outline_json` leaves out, and extensions, except where one may say that
/// geometry is compressed. Fails, at `path`, where an object that is read has a property twice. Precondition:
/// `outline_json` returned this element.
///
/// The `uri` of a buffer that holds its data becomes "data:", and `find_data_uri` returns it: it may be most of the
/// file, and is no text that needs to be parsed.
std::string reduce_element(std::string_view element, std::string_view list, std::string_view path,
                           const Report& report);

/// Precondition: `reduce_element` shortened the uri of this element.
std::string_view find_data_uri(std::string_view element, const Report& report);

}  // namespace vestige::gltf
