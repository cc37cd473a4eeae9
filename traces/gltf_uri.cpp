#include "traces/gltf_uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace vestige::gltf {

namespace {

constexpr std::string_view kDataScheme = "data:";

/// The six bits of a base64 digit, or -1.
int base64_value(char digit) {
  if (digit >= 'A' && digit <= 'Z') return digit - 'A';
  if (digit >= 'a' && digit <= 'z') return digit - 'a' + 26;
  if (digit >= '0' && digit <= '9') return digit - '0' + 52;
  if (digit == '+') return 62;
  if (digit == '/') return 63;
  return -1;
}

int hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

std::string shorten(std::string_view uri) {
  constexpr std::size_t kShown = 60;
  return uri.size() <= kShown ? std::string(uri) : fmt::format("{}…", uri.substr(0, kShown));
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  return uri.starts_with(kDataScheme);
}

std::vector<std::byte> decode_data_uri(std::string_view uri, std::string_view path, const Report& report) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    report.fail(path, fmt::format("'{}' is not base64 data", shorten(uri)));
  std::string_view digits = uri.substr(comma + 1);
  const std::size_t written = digits.size();
  for (int padding = 0; padding < 2 && digits.ends_with('='); ++padding) digits.remove_suffix(1);
  const bool padded = digits.size() != written;
  if (digits.size() % 4 == 1 || (padded && written % 4 != 0))
    report.fail(path, fmt::format("{} base64 digits are no whole number of bytes", written));
  std::vector<std::byte> bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char digit : digits) {
    const int value = base64_value(digit);
    if (value < 0) report.fail(path, fmt::format("has the character {} which base64 does not know", int{digit}));
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>((bits >> bit_count) & 0xFF));
  }
  return bytes;
}

std::filesystem::path decode_relative_uri(std::string_view uri, std::string_view path, const Report& report) {
  constexpr std::string_view kRemedy = "put the file beside the glTF, or export a .glb, which holds everything";
  if (has_scheme(uri)) report.fail(path, fmt::format("'{}' is not a file beside the glTF", shorten(uri)), kRemedy);
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      name += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
    if (high < 0 || low < 0) report.fail(path, fmt::format("'{}' has a broken %-escape", shorten(uri)));
    name += static_cast<char>(high * 16 + low);
    i += 2;
  }
  if (name.empty() || name.find('\0') != std::string::npos)
    report.fail(path, fmt::format("'{}' names no file", shorten(uri)), kRemedy);
  std::filesystem::path file(name);
  const bool climbs = std::any_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
  if (file.is_absolute() || climbs || name.find('\\') != std::string::npos)
    report.fail(path, fmt::format("'{}' leaves the folder of the glTF", shorten(uri)), kRemedy);
  return file;
}

}  // namespace vestige::gltf
