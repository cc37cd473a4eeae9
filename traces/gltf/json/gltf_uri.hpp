#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// Returns the value of a hexadecimal digit, -1 for any other character.
int hex_value(char digit);

bool is_data_uri(std::string_view uri);

/// Returns the bytes of "data:MEDIATYPE;base64,…" or "data:MEDIATYPE,…" (RFC 2397; RFC 4648 base64, padding optional).
/// Fails at `path`. Warns of a media type that glTF does not allow there (§3.6.1.1).
std::vector<std::byte> decode_data_uri(std::string_view uri, std::string_view path, Report& report);

/// Returns the relative file that a URI names, percent-decoded (RFC 3986). Fails at `path` if the file would lie
/// outside the folder of the glTF ("../", an absolute path) or the URI has a scheme.
std::filesystem::path decode_relative_uri(std::string_view uri, std::string_view path, const Report& report);

}  // namespace vestige::gltf
