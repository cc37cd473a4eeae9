#include "traces/gltf/clean/append_glb.hpp"

#include <cstdint>
#include <string>

namespace vestige::gltf {

namespace {

using Element = GlbBuilder::Json;

/// The lengths of the lists that elements of an appended file refer to.
class Offsets {
 public:
  explicit Offsets(const Element& json) : json_(json) {}

  /// Makes an index, if the element has it, one of the longer list.
  void move(Element& element, const char* key, const char* list) const {
    if (element.contains(key)) move(element[key], list);
  }
  void move(Element& index, const char* list) const { index = index.get<int>() + length(list); }

  int length(const char* list) const { return json_.contains(list) ? static_cast<int>(json_[list].size()) : 0; }

 private:
  const Element& json_;
};

void move_indices(Element& json, const Offsets& offsets, std::size_t bin_bytes) {
  const auto each = [&json](const char* list, const auto& change) {
    if (!json.contains(list)) return;
    for (Element& element : json[list]) change(element);
  };
  each("bufferViews", [&](Element& view) { view["byteOffset"] = view["byteOffset"].get<std::uint64_t>() + bin_bytes; });
  each("accessors", [&](Element& accessor) { offsets.move(accessor, "bufferView", "bufferViews"); });
  each("images", [&](Element& image) { offsets.move(image, "bufferView", "bufferViews"); });
  each("textures", [&](Element& texture) { offsets.move(texture, "source", "images"); });
  each("materials", [&](Element& material) {
    Element& look = material["pbrMetallicRoughness"];
    if (look.contains("baseColorTexture")) offsets.move(look["baseColorTexture"], "index", "textures");
  });
  each("meshes", [&](Element& mesh) {
    for (Element& primitive : mesh["primitives"]) {
      for (Element& accessor : primitive["attributes"]) offsets.move(accessor, "accessors");
      offsets.move(primitive, "indices", "accessors");
      offsets.move(primitive, "material", "materials");
    }
  });
  each("skins", [&](Element& skin) {
    for (Element& joint : skin["joints"]) offsets.move(joint, "nodes");
    offsets.move(skin, "inverseBindMatrices", "accessors");
  });
  each("nodes", [&](Element& node) {
    if (node.contains("children"))
      for (Element& child : node["children"]) offsets.move(child, "nodes");
    offsets.move(node, "mesh", "meshes");
    offsets.move(node, "skin", "skins");
  });
}

}  // namespace

AppendedNodes append_glb(GlbBuilder& builder, GlbBuilder other) {
  const Offsets offsets(builder.json);
  AppendedNodes appended;
  appended.first = offsets.length("nodes");
  for (const Element& root : other.json["scenes"][0]["nodes"])
    appended.roots.push_back(root.get<int>() + appended.first);
  move_indices(other.json, offsets, builder.bin.size());
  for (const char* list : {"nodes", "meshes", "skins", "materials", "textures", "images", "accessors", "bufferViews"})
    if (other.json.contains(list))
      for (Element& element : other.json[list]) builder.add(list, std::move(element));
  builder.bin.insert(builder.bin.end(), other.bin.begin(), other.bin.end());
  return appended;
}

}  // namespace vestige::gltf
