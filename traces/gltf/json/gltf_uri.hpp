#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// What a hexadecimal digit stands for, -1 for any other character.
int hex_value(char digit);

bool is_data_uri(std::string_view uri);

/// The bytes of "data:MEDIATYPE;base64,…" or "data:MEDIATYPE,…" (RFC 2397; RFC 4648 base64, padding optional).
/// Fails at `path`; warns of a media type that glTF does not want there (§3.6.1.1).
std::vector<std::byte> decode_data_uri(std::string_view uri, std::string_view path, Report& report);

/// The relative file that a URI names, percent-decoded (RFC 3986). Fails at `path` when it would leave the folder of
/// the glTF ("../", an absolute path) or has a scheme.
std::filesystem::path decode_relative_uri(std::string_view uri, std::string_view path, const Report& report);

}  // namespace vestige::gltf
