#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/analysis/plot/plot_fixture.hpp"

namespace vestige::test {

/// Writes FOLDER/box.gltf: a box 0.4 m wide, 1 m high and 0.2 m deep that stands on the ground and faces +z, with the
/// animation `turn`, a quarter turn to its left in one second. u runs over the front (0 to 0.5, from its right to its
/// left) and over the back (0.5 to 0.75), v from the top down; all else has u = 0.875.
inline void write_box(const std::filesystem::path& folder) {
  std::vector<float> positions;
  std::vector<float> coordinates;
  std::vector<std::uint16_t> indices;
  const auto face = [&](const std::array<std::array<float, 3>, 4>& corners, float from_u, float to_u) {
    const auto first = static_cast<std::uint16_t>(positions.size() / 3);
    constexpr std::array<float, 4> kV = {1, 1, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) {
      positions.insert(positions.end(), corners[i].begin(), corners[i].end());
      coordinates.insert(coordinates.end(), {i == 1 || i == 2 ? to_u : from_u, kV[i]});
    }
    for (const int step : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<std::uint16_t>(first + step));
  };
  constexpr float kX = 0.2F;
  constexpr float kZ = 0.1F;
  face({{{-kX, 0, kZ}, {kX, 0, kZ}, {kX, 1, kZ}, {-kX, 1, kZ}}}, 0, 0.4999F);
  face({{{kX, 0, -kZ}, {-kX, 0, -kZ}, {-kX, 1, -kZ}, {kX, 1, -kZ}}}, 0.5F, 0.7499F);
  face({{{kX, 0, kZ}, {kX, 0, -kZ}, {kX, 1, -kZ}, {kX, 1, kZ}}}, 0.875F, 0.875F);
  face({{{-kX, 0, -kZ}, {-kX, 0, kZ}, {-kX, 1, kZ}, {-kX, 1, -kZ}}}, 0.875F, 0.875F);
  face({{{-kX, 1, kZ}, {kX, 1, kZ}, {kX, 1, -kZ}, {-kX, 1, -kZ}}}, 0.875F, 0.875F);
  face({{{-kX, 0, -kZ}, {kX, 0, -kZ}, {kX, 0, kZ}, {-kX, 0, kZ}}}, 0.875F, 0.875F);
  const std::array<float, 2> times = {0, 1};
  const std::array<float, 8> rotations = {0, 0, 0, 1, 0, 0.70710678F, 0, 0.70710678F};

  std::ofstream bin(folder / "box.bin", std::ios::binary);
  std::size_t bytes = 0;
  std::string views;
  const auto add = [&](const auto& values) {
    const std::size_t length = values.size() * sizeof(values[0]);
    bin.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(length));
    views += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", views.empty() ? "" : ", ", bytes,
                         length);
    bytes += length;
  };
  add(positions), add(coordinates), add(indices), add(times), add(rotations);
  write_text(folder / "box.gltf",
             fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"name": "box", "mesh": 0}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "indices": 2}}]}}],
"animations": [{{"name": "turn", "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "rotation"}}}}],
  "samplers": [{{"input": 3, "output": 4}}]}}],
"accessors": [
  {{"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3", "min": [-0.2, 0, -0.1], "max": [0.2, 1, 0.1]}},
  {{"bufferView": 1, "componentType": 5126, "count": 24, "type": "VEC2"}},
  {{"bufferView": 2, "componentType": 5123, "count": 36, "type": "SCALAR"}},
  {{"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]}},
  {{"bufferView": 4, "componentType": 5126, "count": 2, "type": "VEC4"}}],
"bufferViews": [{}], "buffers": [{{"uri": "box.bin", "byteLength": {}}}]}})",
                         views, bytes));
}

/// Writes FOLDER/box.png and .json: the upper half of the box's front is the actuator `chest`, the lower `belly`, the
/// back `spine`; nothing else fires.
inline void write_box_map(const std::filesystem::path& folder) {
  constexpr std::array<std::uint8_t, 8> kGrey = {10, 10, 30, 0, 20, 20, 30, 0};
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = 4;
  image.height = 2;
  image.format = PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&image, (folder / "box.png").c_str(), 0, kGrey.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  write_text(folder / "box.json", R"({"actuators": [{"grey": 10, "name": "chest"}, {"grey": 20, "name": "belly"},
    {"grey": 30, "name": "spine"}]})");
}

}  // namespace vestige::test
