#include "traces/gltf/gltf_extensions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>
#include <vector>

#include "traces/gltf/gltf_meshopt.hpp"

namespace vestige::gltf {

namespace {

using nlohmann::json;

constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Whether an extension changes neither geometry nor skin nor motion, or is supported.
bool is_harmless(std::string_view extension) {
  constexpr std::array<std::string_view, 8> kNames = {kQuantization,
                                                      kMeshopt,
                                                      "VRM",
                                                      "MOZ_hubs_components",
                                                      "KHR_environment_map",
                                                      "EXT_structural_metadata",
                                                      "EXT_mesh_features",
                                                      "CESIUM_primitive_outline"};
  constexpr std::array<std::string_view, 13> kPrefixes = {
      "KHR_texture_",  "KHR_lights_", "KHR_xmp",       "EXT_texture_", "EXT_lights_", "MSFT_texture_",          "VRMC_",
      "EXT_materials", "FB_material", "MSFT_packing_", "GODOT_single", "KHR_audio",   "KHR_node_selectability",
  };
  return extension.find("_materials_") != std::string_view::npos ||
         std::find(kNames.begin(), kNames.end(), extension) != kNames.end() ||
         std::any_of(kPrefixes.begin(), kPrefixes.end(), [&](auto prefix) { return extension.starts_with(prefix); });
}

/// Returns the visible effect of ignoring an extension, or an empty text if there is nothing to report.
std::string_view effect_of_ignoring(std::string_view extension) {
  if (extension == "EXT_mesh_gpu_instancing") return " (an instanced mesh is drawn once)";
  if (extension == "KHR_node_visibility") return " (hidden nodes are drawn)";
  return "";
}

std::vector<std::string> harmful_extensions(const std::vector<std::string>& names) {
  std::vector<std::string> harmful;
  std::copy_if(names.begin(), names.end(), std::back_inserter(harmful),
               [](const std::string& name) { return !is_harmless(name); });
  return harmful;
}

}  // namespace

bool check_extensions(const json& head, Report& report) {
  const auto required = head.value("extensionsRequired", std::vector<std::string>());
  const auto used = head.value("extensionsUsed", std::vector<std::string>());
  if (const auto names = harmful_extensions(required); !names.empty())
    report.fail("extensionsRequired",
                fmt::format("cannot be read without {}, which is not supported", fmt::join(names, ", ")),
                "export the file without it");
  if (auto names = harmful_extensions(used); !names.empty()) {
    for (std::string& name : names) name += effect_of_ignoring(name);
    report.warn("extensionsUsed", fmt::format("ignored {}", fmt::join(names, ", ")));
  }
  std::set<std::string_view> known(used.begin(), used.end());
  for (const std::string& name : required)
    if (!known.contains(name)) report.warn(fmt::format("extensionsRequired '{}'", name), "is not in extensionsUsed");
  known.insert(required.begin(), required.end());
  return known.contains(kQuantization);
}

void refuse_draco(const json& primitive, const std::string& path, const Report& report) {
  const auto extensions = primitive.find("extensions");
  if (extensions != primitive.end() && extensions->is_object() && extensions->contains(kDraco))
    report.fail(path, fmt::format("is compressed by {}", kDraco), "export the file without compression");
}

}  // namespace vestige::gltf
