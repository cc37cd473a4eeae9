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

/// Before anything recursive sees the text.
void refuse_deep_nesting(std::string_view text, const Report& report) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char character = text[i];
    if (in_string) {
      if (character == '\\') ++i;
      in_string = character != '"';
      continue;
    }
    in_string = character == '"';
    if (character == '[' || character == '{') ++depth;
    if (character == ']' || character == '}') --depth;
    if (depth > kDeepestNesting)
      report.fail("", fmt::format("the JSON is nested more than {} deep", kDeepestNesting),
                  "is it really a glTF file?");
  }
}

void drop_unread(json& value, int depth) {
  if (value.is_object())
    for (auto entry = value.begin(); entry != value.end();)
      entry = is_read(entry.key(), depth) ? ++entry : value.erase(entry);
  if (!value.is_structured()) return;
  for (json& element : value)
    if (element.is_structured()) drop_unread(element, depth + 1);
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
  refuse_deep_nesting(text, report);
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& error) {
    report.fail("", fmt::format("the JSON cannot be read: {}", error.what()));
  }
  if (!document.is_object()) report.fail("", "the JSON is not an object");
  drop_unread(document, 1);
  check_schema(document, report);
  check_strides(document, report);
  return document;
}

void check_strides(const json& document, const Report& report) {
  const auto each = [](const json& object, const char* list, const auto& action) {
    const auto found = object.find(list);
    for (std::size_t i = 0; found != object.end() && i < found->size(); ++i) action((*found)[i], i);
  };
  const auto check = [&](const json& object, const char* name, const std::string& path) {
    const auto accessor = object.find(name);
    if (accessor == object.end()) return;
    const json& read = document["accessors"][accessor->get<std::size_t>()];
    if (!read.contains("bufferView")) return;
    const auto view = read["bufferView"].get<std::size_t>();
    if (document["bufferViews"][view].contains("byteStride"))
      report.fail(fmt::format("bufferViews[{}].byteStride", view),
                  fmt::format("is only for vertex attributes, not for {}.{}", path, name));
  };
  each(document, "skins",
       [&](const json& skin, std::size_t i) { check(skin, "inverseBindMatrices", fmt::format("skins[{}]", i)); });
  each(document, "meshes", [&](const json& mesh, std::size_t i) {
    each(mesh, "primitives", [&](const json& primitive, std::size_t k) {
      check(primitive, "indices", fmt::format("meshes[{}].primitives[{}]", i, k));
    });
  });
  each(document, "animations", [&](const json& animation, std::size_t i) {
    each(animation, "samplers", [&](const json& sampler, std::size_t k) {
      check(sampler, "input", fmt::format("animations[{}].samplers[{}]", i, k));
      check(sampler, "output", fmt::format("animations[{}].samplers[{}]", i, k));
    });
  });
}

}  // namespace vestige::gltf
