#include "traces/gltf/clean/look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "traces/base/error.hpp"
#include "traces/gltf/glb_container.hpp"
#include "traces/gltf/gltf_accessor.hpp"

namespace vestige::gltf {

namespace {

using Tree = GlbBuilder::Json;

/// Returns all of a GLB's JSON; an empty object if it cannot be parsed, for example for a number beyond double.
Tree parse_all(std::span<const std::byte> glb, Report& report) {
  std::string_view text = split_glb(glb, report).json;
  while (text.ends_with('\0')) text.remove_suffix(1);
  Tree json = Tree::parse(text, nullptr, false);
  return json.is_object() ? json : Tree::object();
}

/// Returns a member of an object, or null if there is none.
const Tree& member(const Tree& object, const char* name) {
  static const Tree none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

/// Returns the element of the document's list that `index` refers to, or null.
const Tree& element(const Tree& document, const char* list, const Tree& index) {
  static const Tree none;
  const Tree& elements = member(document, list);
  if (!index.is_number_unsigned() || !elements.is_array() || index.get<std::size_t>() >= elements.size()) return none;
  return elements[index.get<std::size_t>()];
}

bool is_share(const Tree& number) {
  return number.is_number() && number.get<double>() >= 0 && number.get<double>() <= 1;
}

bool is_colour(const Tree& colour) {
  return colour.is_array() && colour.size() == 4 && std::all_of(colour.begin(), colour.end(), is_share);
}

/// Whether a JPEG's segments lead to the start of a baseline or progressive frame.
bool is_jpeg(std::string_view bytes) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  if (!bytes.starts_with("\xFF\xD8")) return false;
  for (std::size_t at = 2; at + 10 < bytes.size() && byte(at) == 0xFF; at += 2U + byte(at + 2) * 256U + byte(at + 3))
    if (byte(at + 1) >= 0xC0 && byte(at + 1) <= 0xC2) return true;
  return false;
}

bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1A\n") && bytes.substr(8).find("IHDR") == 4 &&
         bytes.find("IDAT") != std::string_view::npos;
}

}  // namespace

Look::Look(std::span<const std::byte> glb, const Document& document, GlbBuilder& builder)
    : report_(""), document_(document), json_(parse_all(glb, report_)), builder_(builder) {}

Tree Look::asset() const {
  Tree asset = {{"version", "2.0"}};
  for (const char* name : {"generator", "copyright"})
    if (const Tree text = member(member(json_, "asset"), name); text.is_string() && text != "") asset[name] = text;
  return asset;
}

void Look::add_normals(Tree& attributes, std::size_t mesh, std::size_t primitive, std::size_t vertex_count) {
  const auto& known = document_.model.meshes[mesh].primitives[primitive].attributes;
  const auto found = known.find("NORMAL");
  if (found == known.end()) return;
  std::vector<float> normals;
  try {
    const unsigned components = kFloat | (document_.quantized ? kNormalizedInt8 | kNormalizedInt16 : 0U);
    const AccessorReader reader(document_, found->second, {TINYGLTF_TYPE_VEC3, components}, "NORMAL", report_);
    if (reader.count() != vertex_count) return;
    for (std::size_t i = 0; i < reader.count(); ++i) {
      const glm::dvec3 read(reader.number(i, 0), reader.number(i, 1), reader.number(i, 2));
      const double length = glm::length(read);
      if (!(length > 0) || !std::isfinite(length)) return;
      const double scale = std::abs(length - 1) < 1e-3 ? 1 : 1 / length;  // as they are if they are near enough
      for (int axis = 0; axis < 3; ++axis) normals.push_back(static_cast<float>(read[axis] * scale));
    }
  } catch (const Error&) {
    return;  // the normals have a wrong format
  }
  attributes["NORMAL"] = builder_.add_accessor(normals, "VEC3", 3, Target::kVertices);
}

void Look::set_material(Tree& primitive, std::size_t mesh, std::size_t index) {
  const Tree& number = member(element(element(json_, "meshes", mesh), "primitives", index), "material");
  const Tree& source = element(json_, "materials", number);
  if (!source.is_object()) return;
  const auto [known, is_new] = material_of_.try_emplace(number.get<std::size_t>());
  if (is_new) known->second = add_material(source);
  primitive["material"] = known->second;
}

int Look::add_material(const Tree& source) {
  Tree material = Tree::object();
  const Tree pbr = member(source, "pbrMetallicRoughness");
  Tree& look = material["pbrMetallicRoughness"] = Tree::object();
  if (const Tree colour = member(pbr, "baseColorFactor"); is_colour(colour)) look["baseColorFactor"] = colour;
  for (const char* name : {"metallicFactor", "roughnessFactor"})
    if (const Tree share = member(pbr, name); is_share(share)) look[name] = share;
  if (const int texture = add_texture(member(pbr, "baseColorTexture")); texture >= 0)
    look["baseColorTexture"] = {{"index", texture}};
  if (const Tree name = member(source, "name"); name.is_string() && name != "") material["name"] = name;
  if (const Tree sided = member(source, "doubleSided"); sided.is_boolean()) material["doubleSided"] = sided;
  if (const Tree mode = member(source, "alphaMode"); mode == "MASK" || mode == "BLEND") material["alphaMode"] = mode;
  return builder_.add("materials", std::move(material));
}

int Look::add_texture(const Tree& reference) {
  const Tree source = member(element(json_, "textures", member(reference, "index")), "source");
  const Tree number = member(element(json_, "images", source), "bufferView");
  if (member(reference, "texCoord").is_number() && member(reference, "texCoord") != 0) return -1;
  if (!number.is_number_unsigned() || number.get<std::size_t>() >= document_.views.size()) return -1;
  const auto index = number.get<std::size_t>();
  if (const auto known = texture_of_.find(index); known != texture_of_.end()) return known->second;
  const BufferView& view = document_.views[index];
  const std::span<const std::byte> buffer = document_.buffers[view.buffer];
  if (view.offset + view.length > buffer.size()) return -1;
  const std::span<const std::byte> bytes = buffer.subspan(view.offset, view.length);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!is_png(text) && !is_jpeg(text)) return -1;
  const int image = builder_.add("images", {{"bufferView", builder_.add_view(bytes, Target::kNone)},
                                            {"mimeType", is_png(text) ? "image/png" : "image/jpeg"}});
  return texture_of_[index] = builder_.add("textures", {{"source", image}});
}

void Look::finish() {
  for (const char* name : {"VRM", "VRMC_vrm"}) {
    const Tree bones = member(member(member(member(json_, "extensions"), name), "humanoid"), "humanBones");
    if (bones.is_null()) continue;
    builder_.json["extensionsUsed"].push_back(name);
    builder_.json["extensions"][name]["humanoid"]["humanBones"] = bones;
  }
}

}  // namespace vestige::gltf
