#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// The two chunks of a binary glTF file (glTF 2.0 §4.4), as views into it.
struct GlbChunks {
  std::string_view json;
  std::span<const std::byte> bin;  ///< empty if there is no BIN chunk
};

/// Splits a GLB into its chunks. Checks magic, version and all lengths. The chunks must be JSON, at most one BIN, then
/// unknown ones. Unknown chunks and bytes after the end are skipped with a warning. Fails with the byte offset.
GlbChunks split_glb(std::span<const std::byte> glb, Report& report);

/// Joins the chunks into a GLB: header, JSON padded with spaces, BIN padded with zeros (left out if empty). Fails
/// beyond 4 GiB.
std::vector<std::byte> join_glb(std::string_view json, std::span<const std::byte> bin, const Report& report);

}  // namespace vestige::gltf
