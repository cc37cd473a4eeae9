#include "traces/gltf/json/gltf_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "traces/base/utf8.hpp"
#include "traces/gltf/json/gltf_uri.hpp"

namespace vestige::gltf {

namespace {

// glTF itself needs 9 levels. Only extras and extensions go deeper, and they are dropped.
constexpr int kDeepestNesting = 128;

bool is_digit(char character) {
  return character >= '0' && character <= '9';
}

/// Whether an ASCII character represents itself inside a JSON text.
bool is_plain(char character) {
  return character >= 0x20 && character != '"' && character != '\\';
}

/// Whether a property is read, by its name and the depth of its object. Depth 1 is the document, 3 an element of one of
/// its lists (a node), 5 an element of a list in that (a primitive).
bool is_read(std::string_view key, int depth, std::string_view list) {
  constexpr std::array<std::string_view, 5> kUnreadLists = {"materials", "textures", "images", "samplers", "cameras"};
  if (key == "extras") return false;
  if (key == "extensions")
    return (depth == 5 && list == "meshes") || (depth == 3 && (list == "bufferViews" || list == "buffers"));
  if (key == "camera") return depth != 3;
  if (key == "material") return depth != 5;
  return depth != 1 || std::find(kUnreadLists.begin(), kUnreadLists.end(), key) == kUnreadLists.end();
}

/// Walks over JSON text. Recursive, but never deeper than `kDeepestNesting`.
class Scanner {
 public:
  Scanner(std::string_view text, const Report& report) : text_(text), report_(report) {}

  Outline outline() {
    Outline result;
    skip_space();
    if (peek() != '{') fail("is not an object");
    each_member(1, [&](const std::string& key, std::string_view) {
      const std::size_t start = at_;
      if (!is_read(key, 1, {})) {
        skip_value(2);
        if (key == "extensions") result.extensions = text_.substr(start, at_ - start);
        return;
      }
      bool is_new = false;
      if (peek() == '[' && !key.starts_with("extensions")) {
        std::vector<std::string_view> elements;
        each_element(2, [&] {
          const std::size_t first = at_;
          skip_value(3);
          elements.push_back(text_.substr(first, at_ - first));
        });
        is_new = result.lists.emplace(key, std::move(elements)).second && !result.properties.contains(key);
      } else {
        skip_value(2);
        is_new = result.properties.emplace(key, text_.substr(start, at_ - start)).second && !result.lists.contains(key);
      }
      if (!is_new) report_.fail(key, "appears more than once");
    });
    skip_space();
    if (at_ != text_.size()) fail("has something after its end");
    return result;
  }

  std::string_view data_uri() {
    std::string_view found;
    each_member(3, [&](const std::string& key, std::string_view) {
      const std::size_t start = at_;
      skip_value(4);
      if (key == "uri") found = text_.substr(start + 1, at_ - start - 2);
    });
    return found;
  }

  /// Appends the value to `out`, without the parts that are not read.
  void reduce(int depth, std::string_view list, std::string_view path, std::string& out) {
    const std::size_t start = at_;
    if (peek() == '{') {
      std::vector<std::string> keys;
      out += '{';
      each_member(depth, [&](std::string key, std::string_view quoted) {
        if (!is_read(key, depth, list)) return skip_value(depth + 1);
        if (!keys.empty()) out += ',';
        out.append(quoted) += ':';
        const bool may_hold_data = depth == 3 && list == "buffers" && key == "uri";
        const bool is_bound = depth == 3 && list == "accessors" && (key == "min" || key == "max");
        keys.push_back(std::move(key));
        if (is_bound) return reduce_bound(out);
        if (!may_hold_data || peek() != '"') return reduce(depth + 1, list, path, out);
        const std::size_t first = at_;
        skip_string();
        const std::string_view uri = text_.substr(first, at_ - first);
        out += is_plain_data_uri(uri) ? kShortened : uri;
      });
      out += '}';
      std::sort(keys.begin(), keys.end());
      const auto twice = std::adjacent_find(keys.begin(), keys.end());
      if (twice != keys.end()) report_.fail(path, fmt::format("has '{}' more than once", *twice));
    } else if (peek() == '[') {
      bool is_first = true;
      out += '[';
      each_element(depth, [&] {
        if (!is_first) out += ',';
        is_first = false;
        reduce(depth + 1, list, path, out);
      });
      out += ']';
    } else {
      skip_value(depth);
      out += text_.substr(start, at_ - start);
    }
  }

 private:
  static constexpr std::string_view kShortened = "\"data:\"";

  /// Nothing relies on an accessor's bounds, so numbers there that exceed double do no harm; they become null.
  void reduce_bound(std::string& out) {
    const std::size_t start = at_;
    skip_value(4);
    const std::string_view bound = text_.substr(start, at_ - start);
    out += nlohmann::json::accept(bound) ? bound : "null";
  }

  /// Without escapes, the raw text is the URI.
  static bool is_plain_data_uri(std::string_view value) {
    return value.starts_with("\"data:") && value.find('\\') == std::string_view::npos;
  }

  /// Returns zero at the end of the text; JSON never contains a zero.
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_space() {
    while (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r') ++at_;
  }

  bool take(char character) {
    if (peek() != character) return false;
    ++at_;
    return true;
  }

  void enter(int depth) {
    if (depth > kDeepestNesting)
      report_.fail("", fmt::format("the JSON is nested more than {} deep", kDeepestNesting),
                   "remove the deep extras or extensions");
    ++at_;
    skip_space();
  }

  /// Calls `action` with each key, both decoded and raw; `action` must move past the value.
  template <typename Action>
  void each_member(int depth, const Action& action) {
    enter(depth);
    if (take('}')) return;
    do {
      skip_space();
      const std::size_t start = at_;
      if (peek() != '"') fail("needs the name of a property here");
      skip_string();
      const std::string_view quoted = text_.substr(start, at_ - start);
      skip_space();
      if (!take(':')) fail("needs a ':' here");
      skip_space();
      action(decode(quoted), quoted);
      skip_space();
    } while (take(','));
    if (!take('}')) fail("needs a ',' or a '}' here");
  }

  template <typename Action>
  void each_element(int depth, const Action& action) {
    enter(depth);
    if (take(']')) return;
    do {
      skip_space();
      action();
      skip_space();
    } while (take(','));
    if (!take(']')) fail("needs a ',' or a ']' here");
  }

  void skip_value(int depth) {
    if (peek() == '{') return each_member(depth, [&](const std::string&, std::string_view) { skip_value(depth + 1); });
    if (peek() == '[') return each_element(depth, [&] { skip_value(depth + 1); });
    if (peek() == '"') return skip_string();
    for (const std::string_view word : {"true", "false", "null"})
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return;
      }
    skip_number();
  }

  void skip_string() {
    constexpr std::string_view kEscapes = "\"\\/bfnrtu";
    ++at_;
    for (;;) {
      while (at_ < text_.size() && is_plain(text_[at_])) ++at_;
      if (take('"')) return;
      if (at_ >= text_.size()) fail("ends inside a text");
      if (static_cast<unsigned char>(peek()) < 0x20) fail("has a control character inside a text");
      if (take('\\')) {
        if (at_ >= text_.size() || kEscapes.find(peek()) == std::string_view::npos) fail("has a broken escape");
        if (take('u')) {
          const std::string_view digits = text_.substr(at_, 4);
          if (digits.size() != 4 ||
              std::any_of(digits.begin(), digits.end(), [](char digit) { return hex_value(digit) < 0; }))
            fail("has a broken escape");
          at_ += 3;
        }
        ++at_;
        continue;
      }
      const std::size_t length = utf8_length(text_.substr(at_));
      if (length == 0) fail("is not UTF-8");
      at_ += length;
    }
  }

  void skip_digits() {
    if (!is_digit(peek())) fail("has something that is not a value");
    while (is_digit(peek())) ++at_;
  }

  void skip_number() {
    take('-');
    if (!take('0')) skip_digits();
    if (take('.')) skip_digits();
    if (take('e') || take('E')) {
      if (!take('+')) take('-');
      skip_digits();
    }
  }

  std::string decode(std::string_view quoted) const {
    if (quoted.find('\\') == std::string_view::npos) return std::string(quoted.substr(1, quoted.size() - 2));
    const nlohmann::json key = nlohmann::json::parse(quoted, nullptr, false);
    if (!key.is_string()) fail("has a broken escape");
    return key.get<std::string>();
  }

  [[noreturn]] void fail(std::string_view cause) const {
    report_.fail("", fmt::format("the JSON cannot be read: at its byte {} it {}", at_, cause));
  }

  std::string_view text_;
  const Report& report_;
  std::size_t at_ = 0;
};

}  // namespace

Outline outline_json(std::string_view text, const Report& report) {
  return Scanner(text, report).outline();
}

std::string reduce_element(std::string_view element, std::string_view list, std::string_view path,
                           const Report& report) {
  std::string result;
  Scanner(element, report).reduce(3, list, path, result);
  return result;
}

std::string_view find_data_uri(std::string_view element, const Report& report) {
  return Scanner(element, report).data_uri();
}

}  // namespace vestige::gltf
