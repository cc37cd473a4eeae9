#include "analysis/view/page.hpp"

#include <map>
#include <stdexcept>
#include <string_view>

#include "analysis/base/html.hpp"
#include "analysis/view/page_files.hpp"

namespace vestige {

namespace {

using namespace page_files;

/// JSON that a <script> element can hold: no text in it ends the element or begins a comment.
std::string script_json(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char letter : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
    if (letter == '<')
      text += "\\u003c";
    else
      text += letter;
  }
  return text;
}

std::string all_scripts() {
  std::string text;
  for (const std::string_view script : {kDataJs, kTraceJs, kBodyJs, kSceneJs, kStillJs, kRasterJs, kPlayerJs})
    text += script;
  return text;
}

}  // namespace

std::string make_page(const std::string& title, const PageContent& content) {
  const std::string shown_title = html_text(title);
  const std::string head = script_json(content.head);
  const std::string scripts = all_scripts();
  const std::map<std::string_view, std::string_view> parts = {
      {"TITLE", shown_title},      {"STYLE", kStyleCss},     {"HEAD", head},
      {"DATA", content.data},      {"LICENCE", kLicenceTxt}, {"THREE", kThreeMinJs},
      {"ORBIT", kOrbitControlsJs}, {"SCRIPT", scripts}};
  std::string page;
  page.reserve(kThreeMinJs.size() + content.data.size() + head.size() + 200'000);
  std::string_view rest = kPageHtml;
  // What takes the place of a mark is not searched for marks.
  for (std::size_t at = rest.find('@'); at != std::string_view::npos; at = rest.find('@')) {
    const std::size_t end = rest.find('@', at + 1);
    if (end == std::string_view::npos) throw std::logic_error("page.html: a mark has no end");
    page += rest.substr(0, at);
    page += parts.at(rest.substr(at + 1, end - at - 1));
    rest.remove_prefix(end + 1);
  }
  return page.append(rest);
}

}  // namespace vestige
