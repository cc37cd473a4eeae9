#pragma once

#include <string>
#include <string_view>

namespace vestige {

/// Escapes `text` for use in an HTML element or in an attribute's quotes: nothing in the result is markup. Control
/// characters become U+FFFD, except \n and \t.
std::string html_text(std::string_view text);

/// Turns an SVG document of `svg_of` into a part of an HTML page. Its width and height are its own size; the page's
/// style may shrink it. Its ids get `prefix` in front, since several pictures share one page's ids. Screen readers read
/// `label` instead of the picture.
std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view label);

}  // namespace vestige
