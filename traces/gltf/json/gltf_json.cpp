#include "traces/gltf/json/gltf_json.hpp"

#include <fmt/format.h>

#include <string>

namespace vestige::gltf {

namespace {

using nlohmann::json;

/// Removes characters around the JSON that glTF forbids (§4.4.3.2) but that do no harm.
std::string_view trim(std::string_view text, Report& report) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    report.warn("", "ignored a byte order mark before the JSON");
    text.remove_prefix(kByteOrderMark.size());
  }
  if (text.ends_with('\0')) {
    report.warn("", "the JSON is padded with zeros instead of spaces");
    text = text.substr(0, text.find_last_not_of('\0') + 1);
  }
  return text;
}

/// Precondition: the grammar of `text` was checked.
json parse(std::string_view text, std::string_view path, const Report& report) {
  try {
    return json::parse(text);
  } catch (const json::out_of_range&) {
    report.fail(path, "the JSON cannot be read: it holds a number too large for a double");
  } catch (const json::parse_error&) {
    report.fail(path, "the JSON cannot be read: it holds half of a surrogate pair");
  }
}

}  // namespace

Json::Json(std::string_view text, Report& report)
    : outline_(outline_json(trim(text, report), report)), head_(json::object()) {
  for (const auto& [name, value] : outline_.properties)
    head_[name] = parse(reduce_element(value, name, name, report), name, report);
  check_head(head_, outline_, report);
}

std::size_t Json::count(std::string_view list) const {
  const auto found = outline_.lists.find(list);
  return found == outline_.lists.end() ? 0 : found->second.size();
}

std::string_view Json::buffer_uri(std::size_t index, const json& buffer, const Report& report) const {
  const auto& uri = buffer["uri"].get_ref<const std::string&>();
  return uri == "data:" ? find_data_uri(outline_.lists.find("buffers")->second[index], report) : uri;
}

json Json::extra(std::string_view list, std::size_t index, std::string_view name) const {
  // Extras may be larger than all else: what is not asked for is never kept.
  const auto is_kept = [name](int depth, json::parse_event_t event, const json& parsed) {
    switch (event) {
      case json::parse_event_t::key:
        return parsed == (depth == 1 ? "extras" : name);
      case json::parse_event_t::object_start:
        return depth <= 1;
      case json::parse_event_t::array_start:
        return false;
      default:
        return true;
    }
  };
  const json element = json::parse(outline_.lists.find(list)->second[index], is_kept);
  if (!element.is_object() || !element.contains("extras") || !element["extras"].is_object()) return {};
  const auto found = element["extras"].find(name);
  return found == element["extras"].end() || found->is_discarded() ? json() : *found;
}

json Json::element(std::string_view list, std::size_t index, Report& report) const {
  const std::string path = fmt::format("{}[{}]", list, index);
  const std::string text = reduce_element(outline_.lists.find(list)->second[index], list, path, report);
  json element = parse(text, path, report);
  check_element(element, list, index, outline_, report);
  return element;
}

}  // namespace vestige::gltf
