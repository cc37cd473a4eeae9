#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// Fails on required extensions that are not supported. Warns of used ones that would change geometry, skin or motion.
/// Returns whether the file declares KHR_mesh_quantization. `head` is the top level of the JSON.
bool check_extensions(const nlohmann::json& head, Report& report);

/// Fails if only Draco could unpack the primitive. Its accessors have no data, which glTF would otherwise read as
/// zeros.
void refuse_draco(const nlohmann::json& primitive, const std::string& path, const Report& report);

}  // namespace vestige::gltf
