#include "traces/gltf_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace vestige::gltf {

namespace {

using nlohmann::json;

// glTF itself needs 9 levels; only extras and extensions go deeper, and those are dropped.
constexpr int kDeepestNesting = 128;

/// Whether a property is read, by its name and the depth of its object: 1 the document, 3 an element of one of its
/// lists (a node), 5 an element of a list in that (a primitive).
bool is_read(std::string_view key, int depth) {
  constexpr std::array<std::string_view, 5> kUnreadLists = {"materials", "textures", "images", "samplers", "cameras"};
  if (key == "extras") return false;
  if (key == "extensions") return depth == 5;  // a primitive says there that it is compressed
  if (key == "camera") return depth != 3;
  if (key == "material") return depth != 5;
  return depth != 1 || std::find(kUnreadLists.begin(), kUnreadLists.end(), key) == kUnreadLists.end();
}

}  // namespace

json parse_json(std::string_view text, Report& report) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    report.warn("", "ignored a byte order mark before the JSON");
    text.remove_prefix(kByteOrderMark.size());
  }
  if (text.ends_with('\0')) {
    report.warn("", "the JSON is padded with zeros instead of spaces");
    text = text.substr(0, text.find_last_not_of('\0') + 1);
  }
  const auto keep = [&](int depth, json::parse_event_t event, const json& parsed) {
    if (depth > kDeepestNesting)
      report.fail("", fmt::format("the JSON is nested more than {} deep", kDeepestNesting),
                  "is it really a glTF file?");
    return event != json::parse_event_t::key || is_read(parsed.get_ref<const std::string&>(), depth);
  };
  json document;
  try {
    document = json::parse(text, keep);
  } catch (const json::exception& error) {
    report.fail("", fmt::format("the JSON cannot be read: {}", error.what()));
  }
  if (!document.is_object()) report.fail("", "the JSON is not an object");
  check_schema(document, report);
  return document;
}

}  // namespace vestige::gltf
