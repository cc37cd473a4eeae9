#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "traces/gltf/avatar_gltf.hpp"

namespace vestige::test {

/// A GLB with this JSON chunk and, unless it is empty, this BIN chunk; both padded as they should be.
inline std::vector<std::byte> make_glb(std::string json, std::vector<std::byte> bin = {}) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bin.resize((bin.size() + 3) / 4 * 4);
  std::vector<std::byte> glb;
  const auto put = [&](const void* data, std::size_t size) {
    const std::size_t start = glb.size();
    glb.resize(start + size);
    if (size > 0) std::memcpy(glb.data() + start, data, size);
  };
  const auto put_u32 = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    put(&word, sizeof word);
  };
  put("glTF", 4);
  put_u32(2);
  put_u32(12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size()));
  put_u32(json.size());
  put("JSON", 4);
  put(json.data(), json.size());
  if (!bin.empty()) {
    put_u32(bin.size());
    put_u32(0x004E4942);  // "BIN" and a zero
    put(bin.data(), bin.size());
  }
  return glb;
}

/// A glTF under construction: change `document` and `bin` at will.
class GltfBuilder {
 public:
  nlohmann::json document = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::byte> bin;

  /// Appends the data as a new accessor with a new, tightly packed buffer view; returns its index.
  template <typename Number>
  std::size_t add(std::string_view type, const std::vector<Number>& numbers) {
    const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
    bin.resize((bin.size() + 3) / 4 * 4);
    const std::size_t offset = bin.size();
    const std::size_t bytes = numbers.size() * sizeof(Number);
    bin.resize(offset + bytes);
    std::memcpy(bin.data() + offset, numbers.data(), bytes);
    document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component_type<Number>()},
                                     {"count", numbers.size() / components},
                                     {"type", type}});
    // Positions and times need bounds.
    if (std::is_same_v<Number, float> && components <= 3 && !numbers.empty()) set_bounds(numbers, components);
    return document["accessors"].size() - 1;
  }

  std::vector<std::byte> glb() const {
    nlohmann::json finished = document;
    if (!bin.empty() && !finished.contains("buffers")) finished["buffers"] = {{{"byteLength", bin.size()}}};
    return make_glb(finished.dump(), bin);
  }

 private:
  template <typename Number>
  void set_bounds(const std::vector<Number>& numbers, std::size_t components) {
    std::vector<Number> least(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(components));
    std::vector<Number> most = least;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      least[i % components] = std::min(least[i % components], numbers[i]);
      most[i % components] = std::max(most[i % components], numbers[i]);
    }
    document["accessors"].back()["min"] = least;
    document["accessors"].back()["max"] = most;
  }

  template <typename Number>
  static int component_type() {
    if (std::is_same_v<Number, float>) return 5126;
    if (std::is_same_v<Number, std::uint32_t>) return 5125;
    if (std::is_same_v<Number, std::uint16_t>) return 5123;
    if (std::is_same_v<Number, std::int16_t>) return 5122;
    if (std::is_same_v<Number, std::uint8_t>) return 5121;
    return 5120;
  }
};

/// A node that shows one triangle in the plane z = 0: (0, 0), (1, 0), (0, 1). Accessor 0 is POSITION.
inline GltfBuilder one_triangle() {
  GltfBuilder builder;
  builder.add("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  builder.document["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
  builder.document["nodes"] = {{{"mesh", 0}}};
  return builder;
}

/// The same triangle on two joints, nodes 1 and, one metre above it, 2. The first two vertices follow joint 0, the
/// third follows joint 1. Accessors: 0 POSITION, 1 JOINTS_0, 2 WEIGHTS_0, 3 inverse bind matrices.
inline GltfBuilder skinned_triangle() {
  GltfBuilder builder = one_triangle();
  builder.add("VEC4", std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  builder.add("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  std::vector<float> matrices(32);
  for (std::size_t i = 0; i < 8; ++i) matrices[i / 4 * 16 + i % 4 * 5] = 1;
  matrices[16 + 13] = -1;
  builder.add("MAT4", matrices);
  nlohmann::json& document = builder.document;
  document["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}};
  document["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
  document["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", 3}}};
  return builder;
}

inline nlohmann::json& primitive(GltfBuilder& builder) {
  return builder.document["meshes"][0]["primitives"][0];
}

inline nlohmann::json& attributes(GltfBuilder& builder) {
  return primitive(builder)["attributes"];
}

inline Avatar parse(const GltfBuilder& builder) {
  return parse_avatar_glb(builder.glb(), "test.glb");
}

/// Adds an animation with one channel and returns the builder, for chaining.
inline GltfBuilder& animate(GltfBuilder& builder, int node, std::string_view path, std::string_view interpolation,
                            const std::vector<float>& times_s, const std::vector<float>& values) {
  const std::size_t input = builder.add("SCALAR", times_s);
  const std::size_t output = builder.add(path == "rotation" ? "VEC4" : "VEC3", values);
  builder.document["animations"].push_back(
      {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
  return builder;
}

}  // namespace vestige::test
