#include "traces/gltf_extensions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "traces/gltf_meshopt.hpp"

namespace vestige::gltf {

namespace {

using nlohmann::json;

constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Extensions that change neither geometry nor skin nor motion, and those that are supported.
bool is_harmless(std::string_view extension) {
  constexpr std::array<std::string_view, 3> kNames = {kQuantization, kMeshopt, "VRM"};
  constexpr std::array<std::string_view, 14> kPrefixes = {
      "KHR_materials_", "KHR_texture_",
      "KHR_lights_",    "KHR_xmp",
      "EXT_texture_",   "EXT_lights_",
      "MSFT_texture_",  "VRMC_",
      "EXT_materials",  "MSFT_packing_",
      "FB_material",    "GODOT_single",
      "KHR_audio",      "KHR_node_selectability",
  };
  return std::find(kNames.begin(), kNames.end(), extension) != kNames.end() ||
         std::any_of(kPrefixes.begin(), kPrefixes.end(), [&](auto prefix) { return extension.starts_with(prefix); });
}

std::string harmful_extensions(const json& names) {
  std::string harmful;
  for (const json& name : names)
    if (!is_harmless(name.get_ref<const std::string&>()))
      harmful.append(harmful.empty() ? "" : ", ").append(name.get_ref<const std::string&>());
  return harmful;
}

bool holds(const json& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool check_extensions(const json& head, Report& report) {
  const json required = head.value("extensionsRequired", json::array());
  const json used = head.value("extensionsUsed", json::array());
  if (const std::string names = harmful_extensions(required); !names.empty())
    report.fail("extensionsRequired", fmt::format("cannot be read without {}, which is not supported", names),
                "export the file without it");
  if (const std::string names = harmful_extensions(used); !names.empty())
    report.warn("extensionsUsed", fmt::format("ignored {}", names));
  for (const json& name : required)
    if (!holds(used, name.get_ref<const std::string&>()))
      report.warn("extensionsRequired",
                  fmt::format("names {}, which extensionsUsed does not", name.get_ref<const std::string&>()));
  return holds(used, kQuantization) || holds(required, kQuantization);
}

void refuse_draco(const json& primitive, const std::string& path, const Report& report) {
  const auto extensions = primitive.find("extensions");
  if (extensions != primitive.end() && extensions->is_object() && extensions->contains(kDraco))
    report.fail(path, fmt::format("is compressed by {}", kDraco), "export the file without compression");
}

}  // namespace vestige::gltf
