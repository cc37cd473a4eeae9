#pragma once

#include <string>
#include <string_view>

namespace vestige::plot {

/// `text` as HTML shows it, in an element or an attribute's quotes: nothing in it is markup. Control characters become
/// U+FFFD.
std::string html_text(std::string_view text);

/// An SVG document of `svg_of` as part of an HTML page: as wide as there is room, up to its own size; its ids begin
/// with `prefix`, since several pictures share a page's ids. `label` is what is read out instead.
std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view label);

}  // namespace vestige::plot
