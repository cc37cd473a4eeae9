#include "traces/gltf/json/gltf_uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace vestige::gltf {

namespace {

constexpr std::string_view kDataScheme = "data:";

/// Returns the six bits of a base64 digit, or -1.
int base64_value(char digit) {
  if (digit >= 'A' && digit <= 'Z') return digit - 'A';
  if (digit >= 'a' && digit <= 'z') return digit - 'a' + 26;
  if (digit >= '0' && digit <= '9') return digit - '0' + 52;
  if (digit == '+') return 62;
  if (digit == '/') return 63;
  return -1;
}

/// Precondition: `word` is in lower case.
bool starts_with_any_case(std::string_view text, std::string_view word) {
  return text.size() >= word.size() && std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) {
           return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b - 'A' + 'a') : b);
         });
}

/// Returns the byte of an escape such as "%4a" at `at`, or -1.
int escaped_byte(std::string_view text, std::size_t at) {
  const int high = at + 2 < text.size() ? hex_value(text[at + 1]) : -1;
  const int low = at + 2 < text.size() ? hex_value(text[at + 2]) : -1;
  return high < 0 || low < 0 ? -1 : high * 16 + low;
}

std::string shorten(std::string_view uri) {
  constexpr std::size_t kShown = 60;
  return uri.size() <= kShown ? std::string(uri) : fmt::format("{}…", uri.substr(0, kShown));
}

/// Decodes percent escapes (RFC 3986). Errors name `uri`.
std::string unescape(std::string_view text, std::string_view uri, std::string_view path, const Report& report) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    const int byte = escaped_byte(text, i);
    if (byte < 0) report.fail(path, fmt::format("'{}' has a broken %-escape", shorten(uri)));
    result += static_cast<char>(byte);
    i += 2;
  }
  return result;
}

/// Decodes base64 (RFC 4648) with optional padding. Ignores bits left over after the last byte.
std::vector<std::byte> decode_base64(std::string_view digits, std::string_view path, const Report& report) {
  const std::size_t written = digits.size();
  for (int padding = 0; padding < 2 && digits.ends_with('='); ++padding) digits.remove_suffix(1);
  const bool padded = digits.size() != written;
  if (digits.size() % 4 == 1 || (padded && written % 4 != 0))
    report.fail(path, fmt::format("{} base64 digits do not make whole bytes", written));
  std::vector<std::byte> bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char digit : digits) {
    const int value = base64_value(digit);
    if (value < 0) report.fail(path, fmt::format("has the character {}, which is not a base64 digit", int{digit}));
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>((bits >> bit_count) & 0xFF));
  }
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

}  // namespace

int hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

bool is_data_uri(std::string_view uri) {
  return starts_with_any_case(uri, kDataScheme);
}

std::vector<std::byte> decode_data_uri(std::string_view uri, std::string_view path, Report& report) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos)
    report.fail(path, fmt::format("'{}' has no comma before its data", shorten(uri)));
  std::string_view type = uri.substr(kDataScheme.size(), comma - kDataScheme.size());
  std::string_view data = uri.substr(comma + 1);
  constexpr std::string_view kBase64 = ";base64";
  const bool is_base64 =
      type.size() >= kBase64.size() && starts_with_any_case(type.substr(type.size() - kBase64.size()), kBase64);
  if (is_base64) type.remove_suffix(kBase64.size());
  if (type != "application/octet-stream" && type != "application/gltf-buffer")
    report.warn(path, "has a media type that is not for buffers");
  // Base64 needs no escapes, but its digits may have some.
  std::string unescaped;
  if (!is_base64 || data.find('%') != std::string_view::npos) {
    unescaped = unescape(data, uri, path, report);
    data = unescaped;
  }
  if (is_base64) return decode_base64(data, path, report);
  const auto bytes = std::as_bytes(std::span(data));
  return {bytes.begin(), bytes.end()};
}

std::filesystem::path decode_relative_uri(std::string_view uri, std::string_view path, const Report& report) {
  constexpr std::string_view kRemedy = "put the file beside the glTF, or export a .glb, which holds everything";
  if (has_scheme(uri)) report.fail(path, fmt::format("'{}' is not a file beside the glTF", shorten(uri)), kRemedy);
  const std::string name = unescape(uri, uri, path, report);
  if (name.empty() || name.find('\0') != std::string::npos)
    report.fail(path, fmt::format("'{}' names no file", shorten(uri)), kRemedy);
  std::filesystem::path file(name);
  const bool climbs = std::any_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
  if (file.is_absolute() || climbs || name.find('\\') != std::string::npos)
    report.fail(path, fmt::format("'{}' leaves the folder of the glTF", shorten(uri)), kRemedy);
  return file;
}

}  // namespace vestige::gltf
