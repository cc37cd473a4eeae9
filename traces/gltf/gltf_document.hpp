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

/// `tinygltf::BufferView`, of a tenth of its size: there are as many as an avatar has animation channels.
struct BufferView {
  std::size_t buffer = 0;  ///< into `Document::buffers`
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t stride = 0;  ///< 0: tightly packed
};

/// The same for `tinygltf::Accessor`.
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
  // What the file claims of the first three components; nothing where it claims nothing.
  std::optional<std::array<double, 3>> min;
  std::optional<std::array<double, 3>> max;
  std::optional<Sparse> sparse;
};

/// A glTF whose JSON fits the schema (animations excepted). What its accessors hold is not checked yet.
struct Document {
  explicit Document(Json source) : json(std::move(source)) {}

  Json json;
  tinygltf::Model model;  ///< nodes, meshes, skins and scenes; indices are those of the file
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<bool> is_view_read;                   ///< for each view whether an accessor reads it
  std::map<std::size_t, PackedView> packed;         ///< by the number of their view
  std::vector<bool> is_buffer_read;                 ///< for each buffer; images and other unread data may be missing
  std::vector<std::span<const std::byte>> buffers;  ///< one for each of the file's; empty where no accessor reads it
  std::vector<std::vector<std::byte>> decoded;      ///< what `buffers` refer to where it was a data: URI
  std::size_t data_bytes = 0;  ///< of the file and of what was unpacked: bounds what the avatar may need
  bool quantized = false;      ///< KHR_mesh_quantization: integer positions and texture coordinates are allowed
};

/// All but the animations and the data. Fails on required extensions that are not supported, on whatever does not fit
/// the schema, and on interleaved data that is no vertex attribute.
Document parse_document(Json json, Report& report);

/// Splits, parses and checks a GLB, which the result keeps referring to: all accessors lie inside their buffers. Fails
/// on whatever `split_glb`, `Json`, `parse_document` and `check_accessors` refuse.
Document load_document(std::span<const std::byte> glb, Report& report);

/// Stands as the path of an animation channel that names no node, unless it animates a "pointer".
inline constexpr const char* kNoNode = "(no node)";

/// Animations are most of the JSON of some avatars, and are parsed one at a time.
tinygltf::Animation load_animation(const Document& document, std::size_t index, Report& report);

/// Fails at `path` where `length` bytes from `offset` on, both below 2³², do not lie inside a buffer of `buffer_bytes`.
void check_inside_buffer(std::uint64_t offset, std::uint64_t length, std::size_t buffer, std::uint64_t buffer_bytes,
                         std::string_view path, const Report& report);

/// Only vertex attributes may be interleaved (glTF 2.0 §3.6.2.1): fails, naming `use`, where a byteStride stands behind
/// an accessor.
void refuse_stride(const Document& document, int accessor, std::string_view use, const Report& report);

}  // namespace vestige::gltf
