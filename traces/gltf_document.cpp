#include "traces/gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "traces/glb_container.hpp"
#include "traces/gltf_accessor.hpp"
#include "traces/gltf_json.hpp"
#include "traces/gltf_uri.hpp"

namespace vestige::gltf {

namespace {

using nlohmann::json;

constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr std::string_view kDraco = "KHR_draco_mesh_compression";

/// Extensions that change neither geometry nor skin nor motion, and the one that is supported.
bool is_harmless(std::string_view extension) {
  constexpr std::array<std::string_view, 11> kHarmless = {"KHR_materials_", "KHR_texture_",  "KHR_lights_",   "KHR_xmp",
                                                          "EXT_texture_",   "EXT_lights_",   "MSFT_texture_", "VRMC_",
                                                          "EXT_materials",  "MSFT_packing_", "FB_material"};
  return extension == kQuantization || extension == "VRM" ||
         std::any_of(kHarmless.begin(), kHarmless.end(), [&](auto prefix) { return extension.starts_with(prefix); });
}

std::string harmful_extensions(const json& document, const char* list) {
  std::string names;
  for (const json& name : document.value(list, json::array()))
    if (!is_harmless(name.get_ref<const std::string&>()))
      names.append(names.empty() ? "" : ", ").append(name.get_ref<const std::string&>());
  return names;
}

/// A mesh that only Draco can unpack has accessors without data, which glTF would otherwise read as zeros.
void refuse_draco_without_fallback(const json& document, const Report& report) {
  const json none = json::array();
  const json& meshes = document.contains("meshes") ? document["meshes"] : none;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const json& primitives = meshes[m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const json& primitive = primitives[p];
      if (!primitive.contains("extensions") || !primitive["extensions"].is_object() ||
          !primitive["extensions"].contains(kDraco) || !primitive["attributes"].contains("POSITION"))
        continue;
      const auto position = primitive["attributes"]["POSITION"].get<std::size_t>();
      if (!document["accessors"][position].contains("bufferView"))
        report.fail(fmt::format("meshes[{}].primitives[{}]", m, p), fmt::format("is compressed by {}", kDraco),
                    "export the file without compression");
    }
  }
}

bool check_extensions(const json& document, Report& report) {
  if (const std::string names = harmful_extensions(document, "extensionsRequired"); !names.empty())
    report.fail("extensionsRequired", fmt::format("cannot be read without {}, which is not supported", names),
                "export the file without it");
  if (const std::string names = harmful_extensions(document, "extensionsUsed"); !names.empty())
    report.warn("extensionsUsed", fmt::format("ignored {}", names));
  refuse_draco_without_fallback(document, report);
  const auto names_quantization = [&](const char* list) {
    const json names = document.value(list, json::array());
    return std::find(names.begin(), names.end(), kQuantization) != names.end();
  };
  return names_quantization("extensionsUsed") || names_quantization("extensionsRequired");
}

void resolve_buffers(const json& document, std::span<const std::byte> bin, Document& result, Report& report) {
  const std::vector<bool> is_read = buffers_read(document);
  result.buffers.resize(is_read.size());
  for (std::size_t i = 0; i < is_read.size(); ++i) {
    if (!is_read[i]) continue;
    const json& buffer = document["buffers"][i];
    const auto byte_length = buffer["byteLength"].get<std::size_t>();
    const std::string path = fmt::format("buffers[{}]", i);
    std::span<const std::byte> bytes;
    if (const auto uri = buffer.find("uri"); uri == buffer.end()) {
      if (i != 0 || bin.empty()) report.fail(path, "has neither a uri nor a BIN chunk: there is no data");
      bytes = bin;
    } else if (const auto& text = uri->get_ref<const std::string&>(); is_data_uri(text)) {
      bytes = result.decoded.emplace_back(decode_data_uri(text, path + ".uri", report));
    } else {
      report.fail(path + ".uri", "is in another file, where only one binary file was given",
                  "export a .glb, which holds everything");
    }
    if (bytes.size() < byte_length)
      report.fail(path + ".byteLength", fmt::format("says {} bytes, but there are only {}", byte_length, bytes.size()));
    result.buffers[i] = bytes.first(byte_length);
  }
}

/// tinygltf drops a channel without a node, which would renumber the others: give it one, and a path that is ignored.
void keep_channels_without_node(json& document) {
  const auto animations = document.find("animations");
  if (animations == document.end()) return;
  for (json& animation : *animations)
    for (json& channel : animation["channels"])
      if (!channel["target"].contains("node")) channel["target"] = {{"node", 0}, {"path", "pointer"}};
}

/// Turns JSON that is known to be sound into tinygltf's types. It sees neither buffers nor images, reads no file, and
/// decodes nothing.
tinygltf::Model to_model(json document, const Report& report) {
  keep_channels_without_node(document);
  document.erase("buffers");
  const std::string text = document.dump();
  document = nullptr;  // the tree is larger than the text, and tinygltf builds one of its own

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

}  // namespace

std::vector<bool> buffers_read(const json& document) {
  const json none = json::array();
  const auto list = [&](const char* name) -> const json& { return document.contains(name) ? document[name] : none; };
  std::vector<bool> is_read(list("buffers").size());
  const auto read_view = [&](const json& object) {
    const auto view = object.find("bufferView");
    if (view != object.end())
      is_read[list("bufferViews")[view->get<std::size_t>()]["buffer"].get<std::size_t>()] = true;
  };
  for (const json& accessor : list("accessors")) {
    read_view(accessor);
    if (!accessor.contains("sparse")) continue;
    read_view(accessor["sparse"]["indices"]);
    read_view(accessor["sparse"]["values"]);
  }
  return is_read;
}

Document load_document(std::span<const std::byte> glb, Report& report) {
  const GlbChunks chunks = split_glb(glb, report);
  Document result;
  result.file_bytes = glb.size();
  json document = parse_json(chunks.json, report);
  result.quantized = check_extensions(document, report);
  resolve_buffers(document, chunks.bin, result, report);
  result.model = to_model(std::move(document), report);
  check_accessors(result, report);
  return result;
}

}  // namespace vestige::gltf
