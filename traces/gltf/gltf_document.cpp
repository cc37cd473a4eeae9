#include "traces/gltf/gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "traces/gltf/glb_container.hpp"
#include "traces/gltf/gltf_accessor.hpp"
#include "traces/gltf/gltf_extensions.hpp"
#include "traces/gltf/gltf_meshopt.hpp"
#include "traces/gltf/json/gltf_uri.hpp"

namespace vestige::gltf {

namespace {

using nlohmann::json;

// tinygltf looks up a primitive's indices at once, and refuses accessors that are entirely sparse. It accepts them
// among the attributes, so the indices go there. No attribute has this name.
constexpr const char* kIndicesAsAttribute = "(indices)";

/// Converts valid JSON to tinygltf's types. tinygltf sees neither buffers nor images, reads no file, and decodes
/// nothing.
tinygltf::Model to_model(const std::string& text, const Report& report) {
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string cause;
  std::string warning;
  if (!parser.LoadASCIIFromString(&model, &cause, &warning, text.data(), static_cast<unsigned int>(text.size()), "",
                                  tinygltf::NO_REQUIRE))
    report.fail("", fmt::format("tinygltf cannot read it: {}", cause));
  return model;
}

/// Passes a list to tinygltf, a few elements at a time, because its JSON tree takes ten times as much memory as the
/// text. `prepare` may read and change an element. `take` gets a model that holds some of the elements.
template <typename Prepare, typename Take>
void read_list(const Json& source, const std::string& list, Report& report, const Prepare& prepare, const Take& take) {
  constexpr std::size_t kPieceBytes = 1 << 14;
  const std::size_t count = source.count(list);
  std::string piece;
  for (std::size_t i = 0; i < count; ++i) {
    json element = source.element(list, i, report);
    prepare(element, i);
    element.erase("extensions");
    if (!piece.empty()) piece += ',';
    piece += element.dump();
    if (piece.size() < kPieceBytes && i + 1 < count) continue;
    take(to_model(fmt::format("{{\"{}\":[{}]}}", list, piece), report));
    piece.clear();
  }
}

template <typename T>
void append(std::vector<T>& all, std::vector<T>&& some) {
  all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
}

std::size_t component_count(std::string_view type) {
  if (type == "SCALAR") return 1;
  const auto size = static_cast<std::size_t>(type.back() - '0');
  return type.starts_with("MAT") ? size * size : size;
}

Accessor to_accessor(const tinygltf::Accessor& source) {
  Accessor accessor;
  accessor.view = source.bufferView;
  accessor.component_type = source.componentType;
  accessor.type = source.type;
  accessor.normalized = source.normalized;
  accessor.count = static_cast<std::uint32_t>(source.count);
  accessor.offset = source.byteOffset;
  const auto bound = [](const std::vector<double>& numbers) -> std::optional<std::array<double, 3>> {
    if (numbers.empty()) return std::nullopt;
    std::array<double, 3> first = {};
    std::copy_n(numbers.begin(), std::min(numbers.size(), first.size()), first.begin());
    return first;
  };
  accessor.min = bound(source.minValues);
  accessor.max = bound(source.maxValues);
  if (source.sparse.isSparse)
    accessor.sparse = {static_cast<std::uint32_t>(source.sparse.count),
                       source.sparse.indices.bufferView,
                       static_cast<std::uint32_t>(source.sparse.indices.byteOffset),
                       source.sparse.indices.componentType,
                       source.sparse.values.bufferView,
                       static_cast<std::uint32_t>(source.sparse.values.byteOffset)};
  return accessor;
}

void read_accessors(Document& document, Report& report) {
  document.accessors.reserve(document.json.count("accessors"));
  read_list(
      document.json, "accessors", report,
      [&](json& accessor, std::size_t i) {
        const auto components = component_count(accessor["type"].get_ref<const std::string&>());
        for (const char* bound : {"min", "max"})
          if (accessor.contains(bound) && accessor[bound].size() != components) {
            report.warn(fmt::format("accessors[{}].{}", i, bound),
                        "does not have as many numbers as an element, or has a number too large for a double");
            accessor.erase(bound);
          }
        accessor.erase("name");
      },
      [&](tinygltf::Model&& model) {
        for (const tinygltf::Accessor& accessor : model.accessors) document.accessors.push_back(to_accessor(accessor));
      });
}

void read_views(Document& document, Report& report) {
  document.views.reserve(document.json.count("bufferViews"));
  std::vector<std::uint64_t> strides;  // tinygltf refuses those that are no multiple of 4
  read_list(
      document.json, "bufferViews", report,
      [&](json& view, std::size_t i) {
        const std::string path = fmt::format("bufferViews[{}]", i);
        if (const auto packed = read_packed_view(view, path, document.json.count("buffers"), report))
          document.packed.emplace(i, *packed);
        strides.push_back(view.value("byteStride", std::uint64_t{0}));
        view.erase("byteStride");
        view.erase("name");
      },
      [&](tinygltf::Model&& model) {
        for (const tinygltf::BufferView& view : model.bufferViews)
          document.views.push_back({static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength,
                                    strides[document.views.size()]});
      });
}

void mark_what_is_read(Document& document) {
  document.is_view_read.resize(document.views.size());
  const auto read = [&](int view) { document.is_view_read[static_cast<std::size_t>(view)] = true; };
  for (const Accessor& accessor : document.accessors) {
    if (accessor.view >= 0) read(accessor.view);
    if (!accessor.sparse) continue;
    read(accessor.sparse->indices_view);
    read(accessor.sparse->values_view);
  }
  document.is_buffer_read.resize(document.json.count("buffers"));
  for (std::size_t i = 0; i < document.views.size(); ++i) {
    if (!document.is_view_read[i]) continue;
    const auto packed = document.packed.find(i);
    document.is_buffer_read[packed == document.packed.end() ? document.views[i].buffer : packed->second.buffer] = true;
  }
}

void resolve_buffer(Document& document, std::size_t index, std::span<const std::byte> bin, Report& report) {
  const json buffer = document.json.element("buffers", index, report);
  const auto byte_length = buffer["byteLength"].get<std::size_t>();
  const std::string path = fmt::format("buffers[{}]", index);
  std::span<const std::byte> bytes;
  if (const auto uri = buffer.find("uri"); uri == buffer.end()) {
    if (index != 0 || bin.empty()) report.fail(path, "has neither a uri nor a BIN chunk: there is no data");
    bytes = bin;
  } else if (const std::string_view text = document.json.buffer_uri(index, buffer, report); is_data_uri(text)) {
    bytes = document.decoded.emplace_back(decode_data_uri(text, path + ".uri", report));
  } else {
    report.fail(path + ".uri", "is in another file, but only one binary file was given",
                "name a glTF file that lies beside its other files, or export a .glb, which holds everything");
  }
  if (bytes.size() < byte_length)
    report.fail(path + ".byteLength", fmt::format("says {} bytes, but there are only {}", byte_length, bytes.size()));
  document.buffers[index] = bytes.first(byte_length);
}

void resolve_buffers(Document& document, std::span<const std::byte> bin, Report& report) {
  document.buffers.resize(document.is_buffer_read.size());
  for (std::size_t i = 0; i < document.is_buffer_read.size(); ++i)
    if (document.is_buffer_read[i]) resolve_buffer(document, i, bin, report);

  // No mode packs more than 64 bytes into one. Many views may refer to the same packed bytes.
  std::uint64_t left_bytes = 64 * (document.data_bytes + 1024);
  for (const auto& [view, packed] : document.packed) {
    if (!document.is_view_read[view]) continue;
    const std::string path = fmt::format("bufferViews[{}].extensions.{}", view, kMeshopt);
    const std::span<const std::byte> buffer = document.buffers[packed.buffer];
    check_inside_buffer(packed.offset, packed.length, packed.buffer, buffer.size(), path, report);
    const std::uint64_t size = packed.count * packed.stride;
    if (size > left_bytes)
      report.fail(path, fmt::format("{} unpacked bytes are too many for a file of this size", size));
    left_bytes -= size;
    document.decoded.push_back(unpack(packed, buffer.subspan(packed.offset, packed.length), path, report));
    document.views[view].buffer = document.buffers.size();
    document.views[view].offset = 0;
    document.buffers.emplace_back(document.decoded.back());
    document.data_bytes += size;
  }
}

void read_meshes_of_model(Document& document, Report& report) {
  read_list(
      document.json, "meshes", report,
      [&](json& mesh, std::size_t m) {
        for (std::size_t p = 0; p < mesh["primitives"].size(); ++p) {
          json& primitive = mesh["primitives"][p];
          const auto position = primitive["attributes"].find("POSITION");
          const bool has_data =
              position != primitive["attributes"].end() && document.accessors[position->get<std::size_t>()].view >= 0;
          if (!has_data) refuse_draco(primitive, fmt::format("meshes[{}].primitives[{}]", m, p), report);
          primitive.erase("extensions");
          const auto indices = primitive.find("indices");
          if (indices == primitive.end()) continue;
          primitive["attributes"][kIndicesAsAttribute] = *indices;
          primitive.erase(indices);
        }
      },
      [&](tinygltf::Model&& model) {
        for (tinygltf::Mesh& mesh : model.meshes)
          for (tinygltf::Primitive& primitive : mesh.primitives)
            if (const auto indices = primitive.attributes.extract(kIndicesAsAttribute); !indices.empty())
              primitive.indices = indices.mapped();
        append(document.model.meshes, std::move(model.meshes));
      });
}

void read_model(Document& document, Report& report) {
  const auto nothing = [](json&, std::size_t) {};
  tinygltf::Model& all = document.model;
  read_meshes_of_model(document, report);
  read_list(document.json, "skins", report, nothing,
            [&](tinygltf::Model&& some) { append(all.skins, std::move(some.skins)); });
  read_list(
      document.json, "nodes", report,
      [&](const json& node, std::size_t i) {
        const auto has = [&](const char* name) { return node.contains(name); };
        if (has("matrix") && (has("translation") || has("rotation") || has("scale")))
          report.fail(fmt::format("nodes[{}].matrix", i), "is given together with a translation, rotation or scale");
        if (has("skin") && !has("mesh")) report.warn(fmt::format("nodes[{}].skin", i), "has no effect without a mesh");
      },
      [&](tinygltf::Model&& some) { append(all.nodes, std::move(some.nodes)); });
  read_list(document.json, "scenes", report, nothing,
            [&](tinygltf::Model&& some) { append(all.scenes, std::move(some.scenes)); });
  all.defaultScene = document.json.head().value("scene", -1);
}

void check_strides(const Document& document, Report& report) {
  for (std::size_t i = 0; i < document.model.skins.size(); ++i)
    if (const int matrices = document.model.skins[i].inverseBindMatrices; matrices >= 0)
      refuse_stride(document, matrices, fmt::format("skins[{}].inverseBindMatrices", i), report);
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m)
    for (std::size_t p = 0; p < document.model.meshes[m].primitives.size(); ++p)
      if (const int indices = document.model.meshes[m].primitives[p].indices; indices >= 0)
        refuse_stride(document, indices, fmt::format("meshes[{}].primitives[{}].indices", m, p), report);
}

}  // namespace

tinygltf::Animation load_animation(const Document& document, std::size_t index, Report& report) {
  json animation = document.json.element("animations", index, report);
  // tinygltf drops a channel without a node, which would renumber the others. So such a channel gets a node, and a path
  // that marks it.
  for (json& channel : animation["channels"]) {
    json& target = channel["target"];
    if (!target.contains("node")) target = {{"node", 0}, {"path", target["path"] == "pointer" ? "pointer" : kNoNode}};
  }
  std::string text = animation.dump();
  animation = nullptr;
  text = fmt::format("{{\"animations\":[{}]}}", text);
  return std::move(to_model(text, report).animations.front());
}

void check_inside_buffer(std::uint64_t offset, std::uint64_t length, std::size_t buffer, std::uint64_t buffer_bytes,
                         std::string_view path, const Report& report) {
  if (offset + length > buffer_bytes)
    report.fail(path, fmt::format("{} bytes from byte {} on do not lie inside buffers[{}] of {} bytes", length, offset,
                                  buffer, buffer_bytes));
}

Document parse_document(Json json, Report& report) {
  Document document(std::move(json));
  document.quantized = check_extensions(document.json.head(), report);
  read_views(document, report);
  read_accessors(document, report);
  mark_what_is_read(document);
  read_model(document, report);
  check_strides(document, report);
  return document;
}

Document load_document(std::span<const std::byte> glb, Report& report) {
  const GlbChunks chunks = split_glb(glb, report);
  Document document = parse_document(Json(chunks.json, report), report);
  document.data_bytes = glb.size();
  resolve_buffers(document, chunks.bin, report);
  check_accessors(document, report);
  return document;
}

}  // namespace vestige::gltf
