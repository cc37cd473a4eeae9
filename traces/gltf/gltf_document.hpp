#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "traces/gltf/gltf_meshopt.hpp"
#include "traces/gltf/json/gltf_json.hpp"
#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// `tinygltf::BufferView` in a tenth of its size, because an avatar has as many as animation channels.
struct BufferView {
  std::size_t buffer = 0;  ///< index into `Document::buffers`
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t stride = 0;  ///< 0: tightly packed
};

/// `tinygltf::Accessor` in a smaller size.
struct Accessor {
  struct Sparse {
    std::uint32_t count = 0;
    int indices_view = 0;
    std::uint32_t indices_offset = 0;
    int indices_component_type = 0;
    int values_view = 0;
    std::uint32_t values_offset = 0;
  };
  int view = -1;
  int component_type = 0;  ///< TINYGLTF_COMPONENT_TYPE_…
  int type = 0;            ///< TINYGLTF_TYPE_…
  bool normalized = false;
  std::uint32_t count = 0;
  std::uint64_t offset = 0;
  // The file's claim about the first three components, or nothing if there is no claim.
  std::optional<std::array<double, 3>> min;
  std::optional<std::array<double, 3>> max;
  std::optional<Sparse> sparse;
};

/// A glTF whose JSON fits the schema (except the animations). The content of its accessors is not yet checked.
struct Document {
  explicit Document(Json source) : json(std::move(source)) {}

  Json json;
  tinygltf::Model model;  ///< nodes, meshes, skins and scenes; indices are those of the file
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<bool> is_view_read;                   ///< for each view whether an accessor reads it
  std::map<std::size_t, PackedView> packed;         ///< by index of their view
  std::vector<bool> is_buffer_read;                 ///< for each buffer; unread data such as images may be missing
  std::vector<std::span<const std::byte>> buffers;  ///< the file's, empty if unread; then unpacked views
  std::vector<std::vector<std::byte>> decoded;      ///< decoded data: URIs and unpacked views that `buffers` refer to
  std::size_t data_bytes = 0;  ///< size of the file plus unpacked views: limits the avatar's memory
  bool quantized = false;      ///< KHR_mesh_quantization: integer positions and texture coordinates are allowed
};

/// Parses everything except the animations and the data. Fails on required extensions that are not supported, on
/// anything that does not fit the schema, and on interleaved data that are no vertex attribute.
Document parse_document(Json json, Report& report);

/// Splits, parses and checks a GLB, and keeps references to it: all accessors lie inside their buffers. Fails on
/// everything that `split_glb`, `Json`, `parse_document` and `check_accessors` refuse.
Document load_document(std::span<const std::byte> glb, Report& report);

/// The path of an animation channel that names no node, unless it animates a "pointer".
inline constexpr const char* kNoNode = "(no node)";

/// Parses one animation. Animations are parsed one at a time, because they are most of the JSON of some avatars.
tinygltf::Animation load_animation(const Document& document, std::size_t index, Report& report);

/// Fails at `path` if `length` bytes from `offset` on do not lie inside a buffer of `buffer_bytes`. Precondition:
/// `length` and `offset` are below 2³².
void check_inside_buffer(std::uint64_t offset, std::uint64_t length, std::size_t buffer, std::uint64_t buffer_bytes,
                         std::string_view path, const Report& report);

}  // namespace vestige::gltf
