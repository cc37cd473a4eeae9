#include <meshoptimizer.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/traces/gltf/gltf_builder.hpp"

// Writes one small file for each way in which glTF stores an avatar, in the form that avatar_fuzzer reads.

namespace {

using vestige::test::GltfBuilder;
using vestige::test::one_triangle;
using vestige::test::skinned_triangle;

std::filesystem::path folder;

void save(const std::string& name, const GltfBuilder& builder) {
  nlohmann::json document = builder.document;
  if (!document.contains("buffers")) document["buffers"] = {{{"byteLength", builder.bin.size()}}};
  std::ofstream file(folder / name, std::ios::binary);
  file << document.dump() << '\0';
  file.write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
}

void save_bytes(const std::string& name, const std::vector<std::byte>& bytes) {
  std::ofstream(folder / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

nlohmann::json& primitive(GltfBuilder& builder) {
  return builder.document["meshes"][0]["primitives"][0];
}

GltfBuilder sparse() {
  GltfBuilder builder = one_triangle();
  builder.add("SCALAR", std::vector<std::uint8_t>{1, 2});
  builder.add("VEC3", std::vector<float>{5, 0, 0, 0, 5, 0});
  builder.document["accessors"][0]["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", 1}, {"componentType", 5121}}}, {"values", {{"bufferView", 2}}}};
  return builder;
}

GltfBuilder quantised() {
  GltfBuilder builder = one_triangle();
  const std::size_t position =
      builder.add("VEC3", std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0});
  builder.document["accessors"][position]["count"] = 3;
  builder.document["accessors"][position]["normalized"] = true;
  builder.document["bufferViews"].back()["byteStride"] = 8;
  primitive(builder)["attributes"]["POSITION"] = position;
  builder.document["extensionsUsed"] = builder.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  return builder;
}

GltfBuilder packed() {
  GltfBuilder builder = one_triangle();
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(3, 12));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), builder.bin.data(), 3, 12));
  builder.bin.resize(bytes.size());
  std::memcpy(builder.bin.data(), bytes.data(), bytes.size());
  builder.document["bufferViews"][0] = {
      {"buffer", 1},
      {"byteLength", 36},
      {"extensions",
       {{"EXT_meshopt_compression",
         {{"buffer", 0}, {"byteLength", bytes.size()}, {"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}}}}}};
  builder.document["buffers"] = {{{"byteLength", bytes.size()}}, {{"byteLength", 36}}};
  builder.document["extensionsUsed"] = builder.document["extensionsRequired"] = {"EXT_meshopt_compression"};
  return builder;
}

GltfBuilder indexed(int mode) {
  GltfBuilder builder = skinned_triangle();
  primitive(builder)["indices"] = builder.add("SCALAR", std::vector<std::uint16_t>{0, 1, 2, 0, 2, 1});
  primitive(builder)["mode"] = mode;
  primitive(builder)["targets"] = {{{"POSITION", 0}}};
  builder.document["scenes"] = {{{"nodes", {0, 1}}}};
  builder.document["scene"] = 0;
  builder.document["nodes"][1]["rotation"] = {0, 0, 1, 0};
  builder.document["nodes"][2] = {{"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}}};
  return builder;
}

GltfBuilder morphed() {
  GltfBuilder builder = skinned_triangle();
  const std::size_t times = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t weights = builder.add("SCALAR", std::vector<float>{0, 1, 0.5F, 0});
  primitive(builder)["targets"] = {{{"POSITION", 0}}, {{"POSITION", builder.add("VEC3", std::vector<float>(9, 0.5F))}}};
  builder.document["meshes"][0]["weights"] = {0, 0.25};
  builder.document["nodes"][0]["weights"] = {1, -1};
  builder.document["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
                                     {"samplers", {{{"input", times}, {"output", weights}}}}}};
  return builder;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: avatar_seeds FOLDER\n";
    return 2;
  }
  folder = arguments[1];
  save("triangle", one_triangle());
  save("skinned", skinned_triangle());
  save("sparse", sparse());
  save("quantised", quantised());
  save("packed", packed());
  save("morphed", morphed());
  for (const int mode : {4, 5, 6}) save("mode" + std::to_string(mode), indexed(mode));
  for (const char* interpolation : {"STEP", "LINEAR"}) {
    GltfBuilder builder = skinned_triangle();
    vestige::test::animate(builder, 1, "rotation", interpolation, {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
    vestige::test::animate(builder, 2, "scale", interpolation, {0.5F}, {1, 2, 3});
    save(interpolation, builder);
  }
  GltfBuilder spline = skinned_triangle();
  vestige::test::animate(spline, 1, "translation", "CUBICSPLINE", {0, 1}, std::vector<float>(18));
  save("spline", spline);
  save_bytes("triangle.glb", skinned_triangle().glb());
  GltfBuilder text = one_triangle();
  text.document["buffers"] = {
      {{"byteLength", 36}, {"uri", "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
  text.document["nodes"][0]["extras"] = {{"a", {1, "\u00e9"}}};
  const std::string json = text.document.dump();
  const auto bytes = std::as_bytes(std::span(json));
  save_bytes("triangle.gltf", {bytes.begin(), bytes.end()});
  return 0;
}
