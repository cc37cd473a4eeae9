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

/// What EXT_meshopt_compression says of a buffer view: `count` elements of `stride` bytes are packed into `length`
/// bytes of another buffer.
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

/// What a buffer view, `view`, says of its being packed, if it is. Fails, naming the property, where that does not fit
/// the extension's specification ("Specifying compressed views") or the view itself.
std::optional<PackedView> read_packed_view(const nlohmann::json& view, const std::string& path,
                                           std::size_t buffer_count, const Report& report);

/// The view's content: count * stride bytes. Fails where `packed` cannot be unpacked to so many.
std::vector<std::byte> unpack(const PackedView& view, std::span<const std::byte> packed, const std::string& path,
                              const Report& report);

}  // namespace vestige::gltf
