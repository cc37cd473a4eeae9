#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "traces/gltf_report.hpp"

namespace vestige::gltf {

/// A glTF whose JSON fits the schema and whose accessors all lie inside their buffers. What they hold is not checked
/// yet.
struct Document {
  tinygltf::Model model;  ///< without images, materials and buffers; indices are those of the file
  std::vector<std::span<const std::byte>> buffers;  ///< one for each of the file's; empty where no accessor reads it
  std::vector<std::vector<std::byte>> decoded;      ///< what `buffers` refer to where it was a data: URI
  std::size_t file_bytes = 0;
  bool quantized = false;  ///< KHR_mesh_quantization: integer positions and texture coordinates are allowed
};

/// Splits, parses and checks a GLB, which `Document::buffers` keeps referring to. Fails on required extensions that are
/// not supported, and on whatever `split_glb`, `parse_json` and `check_accessors` refuse.
Document load_document(std::span<const std::byte> glb, Report& report);

/// For each buffer whether an accessor reads it; images and other unread data may be missing.
std::vector<bool> buffers_read(const nlohmann::json& document);

}  // namespace vestige::gltf
