#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

inline constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// The description of a buffer view packed with EXT_meshopt_compression: `count` elements of `stride` bytes are packed
/// into `length` bytes of another buffer.
struct PackedView {
  enum class Mode { kAttributes, kTriangles, kIndices };
  enum class Filter { kNone, kOctahedral, kQuaternion, kExponential };

  std::size_t buffer = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t count = 0;
  std::uint64_t stride = 0;
  Mode mode = Mode::kAttributes;
  Filter filter = Filter::kNone;
};

/// Reads how the buffer view `view` is packed, or returns nothing if it is not packed. Fails, with the property, if the
/// description does not fit the extension's specification ("Specifying compressed views") or the view itself.
std::optional<PackedView> read_packed_view(const nlohmann::json& view, const std::string& path,
                                           std::size_t buffer_count, const Report& report);

/// Returns the view's content: count * stride bytes. Fails if `packed` does not unpack to that many bytes.
std::vector<std::byte> unpack(const PackedView& view, std::span<const std::byte> packed, const std::string& path,
                              const Report& report);

}  // namespace vestige::gltf
