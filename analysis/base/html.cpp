#include "analysis/base/html.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <utility>

namespace vestige {

namespace {

constexpr double kPixelsPerPt = 96.0 / 72;

/// Returns the number in an attribute of the root such as "468pt", or 0.
double points_of(std::string_view root, std::string_view attribute) {
  const std::string begin = fmt::format(" {}=\"", attribute);
  const std::size_t at = root.find(begin);
  return at == std::string_view::npos ? 0
                                      : std::strtod(std::string(root.substr(at + begin.size(), 12)).c_str(), nullptr);
}

/// Puts `prefix` in front of ids and references to ids inside tags.
std::string with_prefixed_ids(std::string_view svg, std::string_view prefix) {
  constexpr std::array<std::string_view, 3> kBefore = {" id=\"", "href=\"#", "url(#"};
  std::string result;
  result.reserve(svg.size() + 256);
  bool in_tag = false;
  for (std::size_t i = 0; i < svg.size(); ++i) {
    if (svg[i] == '<') in_tag = true;
    if (svg[i] == '>') in_tag = false;
    bool replaced = false;
    for (const std::string_view before : kBefore) {
      if (!in_tag || !svg.substr(i).starts_with(before)) continue;
      result.append(before).append(prefix).append("-");
      i += before.size() - 1;
      replaced = true;
      break;
    }
    if (!replaced) result += svg[i];
  }
  return result;
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        if ((static_cast<unsigned char>(letter) < 0x20 && letter != '\n' && letter != '\t') || letter == 0x7F)
          result += "\uFFFD";
        else
          result += letter;
    }
  }
  return result;
}

std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view label) {
  const std::size_t root_begin = svg.find("<svg");
  const std::size_t root_end = svg.find('>', root_begin);
  const std::string_view root = svg.substr(root_begin, root_end - root_begin);
  const double width_pt = points_of(root, "width");
  const double height_pt = points_of(root, "height");
  // Drops the description: `label` replaces it.
  std::size_t inside = root_end + 1;
  if (svg.substr(inside).starts_with("<desc>")) inside = svg.find("</desc>", inside) + 7;
  const std::size_t view = root.find("viewBox=\"");
  const std::string_view view_box = root.substr(view, root.find('"', view + 9) + 1 - view);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" {} "
             "width=\"{:.0f}\" height=\"{:.0f}\" role=\"img\" aria-label=\"{}\">",
             view_box, width_pt * kPixelsPerPt, height_pt * kPixelsPerPt, html_text(label)) +
         with_prefixed_ids(svg.substr(inside), prefix);
}

}  // namespace vestige
