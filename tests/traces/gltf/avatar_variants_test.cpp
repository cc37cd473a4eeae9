#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <fstream>

#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/reference_skinning.hpp"

// One avatar, stored in all the ways that glTF has: each must load as the same triangles, to the bit.

namespace vestige {
namespace {

using nlohmann::json;
using test::GltfBuilder;
using test::primitive;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kSide = 20;
constexpr std::size_t kVertices = kSide * kSide;

/// Numbers that every format stores exactly.
struct Sheet {
  std::vector<float> positions;
  std::vector<float> texture_coordinates;
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  std::vector<std::uint32_t> indices;

  Sheet() {
    for (std::size_t i = 0; i < kVertices; ++i) {
      const std::size_t row = i / kSide;
      const std::size_t second_bit = i / 2 % 2;
      positions.insert(positions.end(), {static_cast<float>(i % kSide), static_cast<float>(row), 1});
      texture_coordinates.insert(texture_coordinates.end(),
                                 {static_cast<float>(i % 2), static_cast<float>(second_bit)});
      const bool is_upper = i / kSide >= kSide / 2;
      joints.insert(joints.end(), {0, 1, 0, 0});
      weights.insert(weights.end(), {is_upper ? 0.F : 1.F, is_upper ? 1.F : 0.F, 0, 0});
    }
    for (std::size_t y = 0; y + 1 < kSide; ++y)
      for (std::size_t x = 0; x + 1 < kSide; ++x)
        for (const std::size_t corner : {y * kSide + x, y * kSide + x + 1, (y + 1) * kSide + x})
          indices.push_back(static_cast<std::uint32_t>(corner));
  }
};

enum Slot : std::size_t { kPosition, kTexture, kJoints, kWeights, kIndices, kInverseBind, kTimes, kRotations };

/// Accessors in the order of `Slot`.
GltfBuilder sheet() {
  const Sheet sheet;
  GltfBuilder builder;
  builder.add("VEC3", sheet.positions);
  builder.add("VEC2", sheet.texture_coordinates);
  builder.add("VEC4", sheet.joints);
  builder.add("VEC4", sheet.weights);
  builder.add("SCALAR", sheet.indices);
  std::vector<float> matrices(32);
  for (std::size_t i = 0; i < 8; ++i) matrices[i / 4 * 16 + i % 4 * 5] = 1;
  matrices[16 + 13] = -10;
  builder.add("MAT4", matrices);
  json& document = builder.document;
  document["meshes"] = {
      {{"primitives",
        {{{"attributes",
           {{"POSITION", kPosition}, {"TEXCOORD_0", kTexture}, {"JOINTS_0", kJoints}, {"WEIGHTS_0", kWeights}}},
          {"indices", kIndices}}}}}};
  document["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 10, 0}}}};
  document["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", kInverseBind}}};
  test::animate(builder, 2, "rotation", "LINEAR", {0, 1, 2}, {0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0});
  return builder;
}

/// All corners of all triangles with their texture coordinates, at rest and moving.
std::vector<double> corners(const Avatar& avatar) {
  std::vector<double> numbers;
  std::vector<glm::dvec3> positions;
  std::vector<Pose> poses = {rest_pose(avatar)};
  for (const double time_s : {0.0, 0.25, 1.0, 1.75, 3.0})
    poses.push_back(sample_animation(avatar, avatar.animations.at(0), time_s));
  for (const Pose& pose : poses) {
    skin_reference(avatar, pose, glm::dvec3(0), positions);
    for (const glm::uvec3& triangle : avatar.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const glm::dvec3& position = positions[triangle[corner]];
        const glm::vec2& texture = avatar.texture_coordinate[triangle[corner]];
        numbers.insert(numbers.end(), {position.x, position.y, position.z, double{texture.x}, double{texture.y}});
      }
  }
  return numbers;
}

const std::vector<double>& wanted() {
  static const std::vector<double> numbers = corners(parse_avatar_glb(sheet().glb(), "sheet.glb"));
  return numbers;
}

void expect_same(const std::vector<std::byte>& glb) {
  const Avatar avatar = parse_avatar_glb(glb, "test.glb");
  EXPECT_THAT(avatar.warnings, IsEmpty());
  EXPECT_TRUE(corners(avatar) == wanted());
}

void expect_same(const GltfBuilder& builder) {
  expect_same(builder.glb());
}

/// Puts an accessor that was just added in the place of another.
void replace(GltfBuilder& builder, Slot slot) {
  json accessor = builder.document["accessors"].back();
  builder.document["accessors"].erase(builder.document["accessors"].size() - 1);
  builder.document["accessors"][slot] = accessor;
}

template <typename Target, typename Source>
std::vector<Target> converted(const std::vector<Source>& numbers, double factor = 1) {
  std::vector<Target> result;
  result.reserve(numbers.size());
  for (const Source number : numbers) result.push_back(static_cast<Target>(factor * static_cast<double>(number)));
  return result;
}

TEST(AvatarVariants, AStrideThatInterleavesNothingIsSaidOnceAndChangesNothing) {
  GltfBuilder builder = sheet();
  for (const auto& [slot, stride] :
       {std::pair(kIndices, 4), std::pair(kInverseBind, 64), std::pair(kTimes, 4), std::pair(kRotations, 16)})
    builder.document["bufferViews"][slot]["byteStride"] = stride;
  const Avatar avatar = parse_avatar_glb(builder.glb(), "test.glb");
  EXPECT_THAT(avatar.warnings, ElementsAre(AllOf(HasSubstr("bufferViews[5].byteStride (and 3 more)"),
                                                 HasSubstr("as it is the size of an element, it changes nothing"))));
  EXPECT_TRUE(corners(avatar) == wanted());

  // No multiple of 4, which tinygltf would refuse.
  builder = sheet();
  builder.add("SCALAR", converted<std::uint16_t>(Sheet().indices));
  builder.document["bufferViews"].back()["byteStride"] = 2;
  replace(builder, kIndices);
  const Avatar small = parse_avatar_glb(builder.glb(), "test.glb");
  EXPECT_THAT(small.warnings, ElementsAre(HasSubstr("byteStride: is meant for vertex attributes only")));
  EXPECT_TRUE(corners(small) == wanted());
}

TEST(AvatarVariants, DataThatIsNotAlignedIsReadWithAWarning) {
  const auto expect_warned = [](const std::vector<std::byte>& glb, const char* warning) {
    const Avatar avatar = parse_avatar_glb(glb, "test.glb");
    EXPECT_THAT(avatar.warnings, ElementsAre(HasSubstr(warning)));
    EXPECT_TRUE(corners(avatar) == wanted());
  };
  GltfBuilder builder = sheet();
  const auto start = builder.document["bufferViews"][kIndices]["byteOffset"].get<std::ptrdiff_t>();
  builder.bin.insert(builder.bin.begin() + start, std::byte{0});
  for (std::size_t view = kIndices; view <= kRotations; ++view) {
    json& offset = builder.document["bufferViews"][view]["byteOffset"];
    offset = offset.get<std::size_t>() + 1;
  }
  expect_warned(builder.glb(), "accessors[4] (and 3 more): does not start at a multiple of its component's size");

  // Chunks whose length has no padding, as some exporters write it.
  const GltfBuilder sound = sheet();
  json document = sound.document;
  document["buffers"] = {{{"byteLength", sound.bin.size()}}};
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4 + 1, ' ');
  std::vector<std::byte> glb = test::make_glb(text, sound.bin);
  const std::size_t padded = (text.size() + 3) / 4 * 4;
  glb.erase(glb.begin() + 20 + static_cast<std::ptrdiff_t>(text.size()),
            glb.begin() + 20 + static_cast<std::ptrdiff_t>(padded));
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(glb.data() + at, &word, sizeof word);
  };
  put(8, glb.size());
  put(12, text.size());
  expect_warned(glb, "byte 12: the chunk's length is not a multiple of 4");
}

TEST(AvatarVariants, SheetIsWhatItShouldBe) {
  const Avatar avatar = parse_avatar_glb(sheet().glb(), "sheet.glb");
  EXPECT_THAT(avatar.warnings, IsEmpty());
  EXPECT_EQ(avatar.triangles.size(), (kSide - 1) * (kSide - 1));
  EXPECT_EQ(wanted().size(), 6 * 15 * avatar.triangles.size());
}

TEST(AvatarVariants, IndicesOfAnyWidthOrNoneAreTheSame) {
  GltfBuilder narrow = sheet();
  narrow.add("SCALAR", converted<std::uint16_t>(Sheet().indices));
  replace(narrow, kIndices);
  expect_same(narrow);

  const Sheet source;
  GltfBuilder plain = sheet();
  std::vector<float> positions;
  std::vector<float> textures;
  std::vector<std::uint8_t> joints;
  std::vector<float> weights;
  for (const std::uint32_t index : source.indices) {
    const auto copy = [&](auto& to, const auto& from, std::size_t size) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(index * size),
                from.begin() + static_cast<std::ptrdiff_t>((index + 1) * size));
    };
    copy(positions, source.positions, 3);
    copy(textures, source.texture_coordinates, 2);
    copy(joints, source.joints, 4);
    copy(weights, source.weights, 4);
  }
  plain.add("VEC3", positions);
  replace(plain, kPosition);
  plain.add("VEC2", textures);
  replace(plain, kTexture);
  plain.add("VEC4", joints);
  replace(plain, kJoints);
  plain.add("VEC4", weights);
  replace(plain, kWeights);
  primitive(plain).erase("indices");
  expect_same(plain);
}

TEST(AvatarVariants, JointsAndWeightsOfAnyWidthAreTheSame) {
  GltfBuilder bytes = sheet();
  bytes.add("VEC4", converted<std::uint8_t>(Sheet().weights, 255));
  replace(bytes, kWeights);
  bytes.document["accessors"][kWeights]["normalized"] = true;
  expect_same(bytes);

  GltfBuilder shorts = sheet();
  shorts.add("VEC4", converted<std::uint16_t>(Sheet().weights, 65535));
  replace(shorts, kWeights);
  shorts.document["accessors"][kWeights]["normalized"] = true;
  shorts.add("VEC4", converted<std::uint16_t>(Sheet().joints));
  replace(shorts, kJoints);
  expect_same(shorts);
}

TEST(AvatarVariants, TextureCoordinatesAndRotationsMayBeNormalisedIntegers) {
  GltfBuilder builder = sheet();
  builder.add("VEC2", converted<std::uint16_t>(Sheet().texture_coordinates, 65535));
  replace(builder, kTexture);
  builder.document["accessors"][kTexture]["normalized"] = true;
  builder.add("VEC4", std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 127, 0, 127, 0, 0, 0});
  replace(builder, kRotations);
  builder.document["accessors"][kRotations]["normalized"] = true;
  expect_same(builder);
}

TEST(AvatarVariants, QuantisedPositionsAreTheSame) {
  GltfBuilder builder = sheet();
  std::vector<std::int16_t> padded;
  for (std::size_t i = 0; i < kVertices; ++i)
    for (std::size_t c = 0; c < 4; ++c)
      padded.push_back(c < 3 ? static_cast<std::int16_t>(Sheet().positions[3 * i + c]) : std::int16_t{0});
  builder.add("VEC4", padded);
  replace(builder, kPosition);
  builder.document["accessors"][kPosition]["type"] = "VEC3";
  builder.document["accessors"][kPosition]["min"] = {0, 0, 1};
  builder.document["accessors"][kPosition]["max"] = {kSide - 1, kSide - 1, 1};
  builder.document["bufferViews"].back()["byteStride"] = 8;
  builder.document["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  expect_same(builder);
}

TEST(AvatarVariants, InterleavedAttributesWithPaddingAreTheSame) {
  const Sheet source;
  constexpr std::size_t kStride = 48;
  GltfBuilder builder = sheet();
  const std::size_t start = (builder.bin.size() + 3) / 4 * 4;
  builder.bin.resize(start + kVertices * kStride, std::byte{0xAB});
  for (std::size_t i = 0; i < kVertices; ++i) {
    std::byte* vertex = builder.bin.data() + start + i * kStride;
    std::memcpy(vertex, source.positions.data() + 3 * i, 12);
    std::memcpy(vertex + 16, source.texture_coordinates.data() + 2 * i, 8);
    std::memcpy(vertex + 24, source.joints.data() + 4 * i, 4);
    std::memcpy(vertex + 28, source.weights.data() + 4 * i, 16);
  }
  const std::size_t view = builder.document["bufferViews"].size();
  builder.document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", start}, {"byteLength", kVertices * kStride - 4}, {"byteStride", kStride}});
  for (const auto& [slot, offset] : {std::pair(kPosition, 0), {kTexture, 16}, {kJoints, 24}, {kWeights, 28}}) {
    builder.document["accessors"][slot]["bufferView"] = view;
    builder.document["accessors"][slot]["byteOffset"] = offset;
  }
  expect_same(builder);
}

TEST(AvatarVariants, AccessorsThatAreAllSparseAreTheSame) {
  GltfBuilder builder = sheet();
  const json dense = builder.document["accessors"];
  for (std::size_t slot = 0; slot < dense.size(); ++slot) {
    const auto count = dense[slot]["count"].get<std::uint16_t>();
    std::vector<std::uint16_t> all;
    for (std::uint16_t i = 0; i < count; ++i) all.push_back(i);
    builder.add("SCALAR", all);
    builder.document["accessors"].erase(builder.document["accessors"].size() - 1);
    json& accessor = builder.document["accessors"][slot];
    accessor["sparse"] = {
        {"count", count},
        {"indices", {{"bufferView", builder.document["bufferViews"].size() - 1}, {"componentType", 5123}}},
        {"values", {{"bufferView", accessor["bufferView"]}}}};
    accessor.erase("bufferView");
  }
  expect_same(builder);
}

/// Makes a view hold the same data packed by meshoptimizer.
void pack(GltfBuilder& builder, std::size_t slot, const std::string& mode, const std::vector<unsigned char>& packed,
          std::size_t count, std::size_t stride) {
  const std::size_t start = (builder.bin.size() + 3) / 4 * 4;
  builder.bin.resize(start + packed.size());
  std::memcpy(builder.bin.data() + start, packed.data(), packed.size());
  json& view = builder.document["bufferViews"][slot];
  view = {{"buffer", 1}, {"byteLength", count * stride}};
  view["extensions"]["EXT_meshopt_compression"] = {
      {"buffer", 0},          {"byteOffset", start}, {"byteLength", packed.size()},
      {"byteStride", stride}, {"count", count},      {"mode", mode}};
}

GltfBuilder packed_sheet(const std::string& index_mode) {
  const Sheet source;
  GltfBuilder builder = sheet();
  builder.bin.erase(builder.bin.begin(), builder.bin.begin() + 12 * kVertices);
  for (json& view : builder.document["bufferViews"])
    if (view["byteOffset"] >= 12 * kVertices)
      view["byteOffset"] = view["byteOffset"].get<std::size_t>() - 12 * kVertices;
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(kVertices, 12));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), source.positions.data(), kVertices, 12));
  pack(builder, kPosition, "ATTRIBUTES", bytes, kVertices, 12);
  bytes.resize(meshopt_encodeIndexSequenceBound(source.indices.size(), kVertices));
  bytes.resize(
      index_mode == "INDICES"
          ? meshopt_encodeIndexSequence(bytes.data(), bytes.size(), source.indices.data(), source.indices.size())
          : meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), source.indices.data(), source.indices.size()));
  pack(builder, kIndices, index_mode, bytes, source.indices.size(), 4);
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()}}, {{"byteLength", 1000000}}};
  builder.document["extensionsUsed"] = {"EXT_meshopt_compression"};
  builder.document["extensionsRequired"] = {"EXT_meshopt_compression"};
  return builder;
}

TEST(AvatarVariants, DataPackedByMeshoptimizerIsTheSame) {
  expect_same(packed_sheet("INDICES"));
  // The other mode may turn triangles round: the same corners, but not the same first.
  GltfBuilder triangles = packed_sheet("TRIANGLES");
  EXPECT_EQ(corners(parse_avatar_glb(triangles.glb(), "a")).size(), wanted().size());
}

TEST(AvatarVariants, DataPackedByMeshoptimizerIsTheSameFromATextFile) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = packed_sheet("INDICES");
  std::ofstream(folder / "a.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
  builder.document["buffers"][0]["uri"] = "a.bin";
  std::ofstream(folder / "a.gltf") << builder.document.dump();
  expect_same(read_avatar_glb(folder / "a.gltf"));
}

TEST(AvatarVariants, PackedDataThatCannotBeIsRefusedByName) {
  const auto refusal = [](const auto& change) -> std::string {
    GltfBuilder builder = packed_sheet("INDICES");
    change(builder, builder.document["bufferViews"][kPosition]["extensions"]["EXT_meshopt_compression"]);
    try {
      parse_avatar_glb(builder.glb(), "test.glb");
    } catch (const Error& error) {
      return error.what();
    }
    return "loaded";
  };
  const std::string path = "bufferViews[0].extensions.EXT_meshopt_compression";
  EXPECT_EQ(refusal([](auto&, auto&) {}), "loaded");
  EXPECT_THAT(refusal([](auto&, json& e) { e["mode"] = "TRIANGLE"; }), HasSubstr(path + ".mode"));
  EXPECT_THAT(refusal([](auto&, json& e) { e.erase("mode"); }), HasSubstr(path + ": 'mode' is missing"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["filter"] = 3; }), HasSubstr(path + ".filter"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["count"] = 401; }), HasSubstr(path + ".count"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["byteStride"] = 10; }), HasSubstr(path + ".byteStride"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["buffer"] = 2; }), HasSubstr(path + ".buffer"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["byteOffset"] = 4000000000U; }),
              HasSubstr("do not lie inside buffers[0]"));
  EXPECT_THAT(refusal([](auto&, json& e) { e["byteLength"] = 20; }), HasSubstr("cannot be unpacked to 400 elements"));
  EXPECT_THAT(refusal([](GltfBuilder& b, json& e) {
                e["count"] = 100000000;
                b.document["bufferViews"][kPosition]["byteLength"] = 1200000000;
              }),
              HasSubstr("are too many for a file of this size"));
}

TEST(AvatarVariants, ATextFileWithManyBuffersOfAllKindsIsTheSame) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = sheet();
  json buffers = json::array();
  for (json& view : builder.document["bufferViews"]) {
    const auto* data = reinterpret_cast<const char*>(builder.bin.data()) + view["byteOffset"].get<std::size_t>();
    const auto length = view["byteLength"].get<std::size_t>();
    const std::size_t index = buffers.size();
    view["buffer"] = index;
    view["byteOffset"] = 0;
    std::string uri;
    if (index % 2 == 0) {
      const std::string name = "dat\u00e4 " + std::to_string(index) + ".bin";
      std::ofstream(folder / name, std::ios::binary).write(data, static_cast<std::streamsize>(length));
      uri = "dat%C3%A4%20" + std::to_string(index) + ".bin";
    } else {
      uri = "data:application/octet-stream,";
      for (std::size_t i = 0; i < length; ++i)
        uri += fmt::format("%{:02x}", static_cast<unsigned>(static_cast<unsigned char>(data[i])));
    }
    buffers.push_back({{"byteLength", length}, {"uri", uri}});
  }
  builder.document["buffers"] = buffers;
  std::ofstream(folder / "a.gltf") << "\xEF\xBB\xBF" << builder.document.dump(1, '\t');
  expect_same(read_avatar_glb(folder / "a.gltf"));
}

TEST(AvatarVariants, AGlbWhoseDataLiesBesideItIsTheSame) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = sheet();
  std::ofstream(folder / "a.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "a.bin"}}};
  const std::vector<std::byte> glb = test::make_glb(builder.document.dump());
  std::ofstream(folder / "a.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  expect_same(read_avatar_glb(folder / "a.glb"));
}

TEST(AvatarVariants, AMixtureOfBinChunkAndFileIsTheSame) {
  const test::TemporaryFolder folder;
  GltfBuilder builder = sheet();
  std::ofstream(folder / "b.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
  builder.document["buffers"] = {{{"byteLength", builder.bin.size()}},
                                 {{"byteLength", builder.bin.size()}, {"uri", "b.bin"}}};
  builder.document["bufferViews"][kPosition]["buffer"] = 1;
  const std::vector<std::byte> glb = builder.glb();
  std::ofstream(folder / "a.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  expect_same(read_avatar_glb(folder / "a.glb"));
}

TEST(AvatarVariants, WhatIsNotReadMayBeAnything) {
  GltfBuilder builder = sheet();
  std::string text = builder.document.dump();
  text.insert(1, R"("buffers":[{"byteLength":)" + std::to_string(builder.bin.size()) +
                     R"(}],"extras":{"a":1e400,"a":[[[]]],"b":-0.0},"materials":[{"extras":1e999}],)");
  text.insert(text.find(R"("mesh":0)"), R"("extras":[1e400,{"x":1,"x":2}],)");
  expect_same(test::make_glb(text, builder.bin));
}

TEST(AvatarVariants, AVrmFileIsTheGltfThatItIs) {
  GltfBuilder builder = sheet();
  builder.document["extensionsUsed"] = {"VRM", "VRMC_vrm", "VRMC_springBone", "KHR_materials_unlit"};
  builder.document["extensions"] = {{"VRM", {{"meta", {{"title", "x"}}}}}, {"VRMC_vrm", {{"specVersion", "1.0"}}}};
  builder.document["nodes"][1]["extensions"] = {{"VRMC_node_constraint", {{"specVersion", "1.0"}}}};
  expect_same(builder);
}

TEST(AvatarVariants, MirroringARigidNodeKeepsItsOutsideOutside) {
  const auto triangle = [](const json& node) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = {node, {{"children", {0}}, {"scale", {1, 1, -1}}}};
    return parse_avatar_glb(builder.glb(), "test.glb").triangles.at(0);
  };
  EXPECT_EQ(triangle({{"mesh", 0}}), glm::uvec3(0, 2, 1)) << "mirrored by its parent";
  EXPECT_EQ(triangle({{"mesh", 0}, {"scale", {-2, 1, 1}}}), glm::uvec3(0, 1, 2)) << "mirrored twice";
  EXPECT_EQ(triangle({{"mesh", 0}, {"scale", {-2, -1, 1}}}), glm::uvec3(0, 2, 1)) << "mirrored thrice";
  GltfBuilder skinned = test::skinned_triangle();
  skinned.document["nodes"][0]["scale"] = {-1, 1, 1};
  EXPECT_THAT(parse_avatar_glb(skinned.glb(), "test.glb").triangles, ElementsAre(glm::uvec3(0, 1, 2)))
      << "a skinned mesh ignores its node";
}

}  // namespace
}  // namespace vestige
