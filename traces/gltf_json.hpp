#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "traces/gltf_report.hpp"

namespace vestige::gltf {

/// Parses a glTF's JSON and drops what detection never reads while doing so: extras, materials, textures, images,
/// texture samplers, cameras, references to them, and extensions (except where they say that geometry is compressed).
/// So a missing or broken image cannot stop the geometry, and the result still refers to nothing that is gone. Then
/// `check_schema`.
///
/// Fails on anything that is not JSON, and on JSON nested deeper than any glTF is.
nlohmann::json parse_json(std::string_view text, Report& report);

/// Checks against the glTF 2.0 schema (§5): required properties, types, ranges, array lengths, allowed words, and that
/// every index refers to something that exists. Unknown properties and empty lists that do no harm are warned of. Whole
/// numbers written as 3.0 become 3.
void check_schema(nlohmann::json& document, Report& report);

/// Only vertex attributes may be interleaved (glTF 2.0 §3.6.2.1): fails where a byteStride stands behind indices,
/// inverse bind matrices or animations. Precondition: the schema fits.
void check_strides(const nlohmann::json& document, const Report& report);

}  // namespace vestige::gltf
