#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "traces/gltf_json.hpp"
#include "traces/gltf_report.hpp"

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

/// A glTF whose JSON fits the schema (animations excepted) and whose accessors all lie inside their buffers. What they
/// hold is not checked yet.
struct Document {
  explicit Document(Json source) : json(std::move(source)) {}

  Json json;
  tinygltf::Model model;  ///< nodes, meshes, skins and scenes; indices are those of the file
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<std::span<const std::byte>> buffers;  ///< one for each of the file's; empty where no accessor reads it
  std::vector<std::vector<std::byte>> decoded;      ///< what `buffers` refer to where it was a data: URI
  std::size_t data_bytes = 0;  ///< of the file and of what was unpacked: bounds what the avatar may need
  bool quantized = false;  ///< KHR_mesh_quantization: integer positions and texture coordinates are allowed
};

/// Splits, parses and checks a GLB, which the result keeps referring to. Fails on required extensions that are not
/// supported, and on whatever `split_glb`, `Json` and `check_accessors` refuse.
Document load_document(std::span<const std::byte> glb, Report& report);

/// Animations are most of the JSON of some avatars, and are parsed one at a time.
tinygltf::Animation load_animation(const Document& document, std::size_t index, Report& report);

/// For each buffer whether an accessor reads it; images and other unread data may be missing.
std::vector<bool> buffers_read(const Json& json, Report& report);

}  // namespace vestige::gltf
