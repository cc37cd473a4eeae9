#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <span>

#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::attributes;
using test::GltfBuilder;
using test::one_triangle;
using test::skinned_triangle;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// What the error says, or "loaded".
std::string refusal(const std::vector<std::byte>& glb) {
  try {
    parse_avatar_glb(glb, "test.glb");
  } catch (const Error& error) {
    return error.what();
  }
  return "loaded";
}

struct Fault {
  std::string expected;  ///< part of the message
  std::function<void(GltfBuilder&)> commit;
};

/// Replaces one float of the data that was added first (the positions) or later.
void put_float(GltfBuilder& builder, std::size_t byte, float value) {
  std::memcpy(builder.bin.data() + byte, &value, sizeof value);
}

void expect_refused(const GltfBuilder& sound, const std::vector<Fault>& faults) {
  ASSERT_EQ(refusal(sound.glb()), "loaded");
  for (const Fault& fault : faults) {
    GltfBuilder broken = sound;
    fault.commit(broken);
    EXPECT_THAT(refusal(broken.glb()), HasSubstr(fault.expected));
  }
}

TEST(RefuseAvatar, NamesAnAccessorThatLeavesItsBuffer) {
  const auto accessor = [](const char* name, auto value) {
    return [=](GltfBuilder& b) { b.document["accessors"][0][name] = value; };
  };
  const auto view = [](const char* name, auto value) {
    return [=](GltfBuilder& b) { b.document["bufferViews"][0][name] = value; };
  };
  expect_refused(
      one_triangle(),
      {{"test.glb: accessors[0]: 4 elements", accessor("count", 4)},
       {"accessors[0].count: 2147483648", accessor("count", 2147483648U)},
       {"accessors[0].count: 0 is not in", accessor("count", 0)},
       {"accessors[0].count: -1 is not a whole number", accessor("count", -1)},
       {"accessors[0].count: 2.5 is not a whole number", accessor("count", 2.5)},
       {"accessors[0].count: is not a number", accessor("count", "3")},
       {"accessors[0]: 3 elements", accessor("byteOffset", 4)},
       {"accessors[0].byteOffset: 18446744073709551608", accessor("byteOffset", 18446744073709551608U)},
       {"accessors[0].bufferView: 1 does not exist", accessor("bufferView", 1)},
       {"accessors[0].componentType: 5124", accessor("componentType", 5124)},
       {"accessors[0].componentType: 5130", accessor("componentType", 5130)},
       {"accessors[0].type: 'VEC5'", accessor("type", "VEC5")},
       {"accessors[0]: is VEC2 of float, but meshes[0]", accessor("type", "VEC2")},
       {"accessors[0]: is VEC3 of uint16", accessor("componentType", 5123)},
       {"bufferViews[0]: 36 bytes", view("byteOffset", 4)},
       {"bufferViews[0].byteOffset: 18446744073709551608", view("byteOffset", 18446744073709551608U)},
       {"bufferViews[0]: 37 bytes", view("byteLength", 37)},
       {"bufferViews[0].byteStride: 253", view("byteStride", 253)},
       {"overlap at a byteStride of 8", view("byteStride", 8)},
       {"accessors[0]: 3 elements", view("byteStride", 16)},
       {"bufferViews[0].buffer: 3 does not exist", view("buffer", 3)},
       {"buffers[0].byteLength: says 40 bytes",
        [](GltfBuilder& b) {
          b.document["buffers"] = {{{"byteLength", 40}}};
        }},
       {"buffers[0]: has neither",
        [](GltfBuilder& b) {
          b.document["buffers"] = {{{"byteLength", 36}}}, b.bin.clear();
        }},
       {"'componentType' is missing", [](GltfBuilder& b) { b.document["accessors"][0].erase("componentType"); }}});
}

TEST(RefuseAvatar, NamesASparseAccessorThatIsBroken) {
  GltfBuilder sound = one_triangle();
  sound.add("SCALAR", std::vector<std::uint8_t>{1, 2});
  sound.add("VEC3", std::vector<float>{5, 0, 0, 0, 5, 0});
  sound.document["accessors"][0]["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", 1}, {"componentType", 5121}}}, {"values", {{"bufferView", 2}}}};
  const auto sparse = [](GltfBuilder& b) -> nlohmann::json& { return b.document["accessors"][0]["sparse"]; };
  expect_refused(sound,
                 {{"accessors[0].sparse.count: 4 is more", [&](GltfBuilder& b) { sparse(b)["count"] = 4; }},
                  {"accessors[0].sparse.indices: 3 elements", [&](GltfBuilder& b) { sparse(b)["count"] = 3; }},
                  {"sparse.indices: 2 elements", [&](GltfBuilder& b) { sparse(b)["indices"]["byteOffset"] = 1; }},
                  {"sparse.values: 2 elements", [&](GltfBuilder& b) { sparse(b)["values"]["byteOffset"] = 4; }},
                  {"sparse.values.byteOffset: 4294967295",
                   [&](GltfBuilder& b) { sparse(b)["values"]["byteOffset"] = 4294967295U; }},
                  {"componentType", [&](GltfBuilder& b) { sparse(b)["indices"]["componentType"] = 5122; }},
                  {"bufferViews[2].byteStride: is 16, but only vertex attributes may be interleaved, not "
                   "accessors[0].sparse.values",
                   [](GltfBuilder& b) { b.document["bufferViews"][2]["byteStride"] = 16; }},
                  {"index 1 is 1", [](GltfBuilder& b) { b.bin[37] = std::byte{1}; }},
                  {"index 1 is 3", [](GltfBuilder& b) { b.bin[37] = std::byte{3}; }}});
}

TEST(RefuseAvatar, NamesNumbersThatAreNotFinite) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  GltfBuilder sound = skinned_triangle();
  attributes(sound)["TEXCOORD_0"] = sound.add("VEC2", std::vector<float>(6));
  test::animate(sound, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  const auto offset = [&](std::size_t accessor) {
    return sound.document["bufferViews"][accessor]["byteOffset"].get<std::size_t>();
  };
  expect_refused(sound, {{"accessors[0]: element 1 of", [&](GltfBuilder& b) { put_float(b, 16, kNan); }},
                         {"attributes.POSITION is not finite", [&](GltfBuilder& b) { put_float(b, 0, kInfinity); }},
                         {"WEIGHTS_0 is not finite", [&](GltfBuilder& b) { put_float(b, offset(2), kNan); }},
                         {"inverseBindMatrices is not", [&](GltfBuilder& b) { put_float(b, offset(3), kInfinity); }},
                         {"TEXCOORD_0 is not finite", [&](GltfBuilder& b) { put_float(b, offset(4), kNan); }},
                         {"samplers[0].input is not finite", [&](GltfBuilder& b) { put_float(b, offset(5), kNan); }},
                         {"samplers[0].output is not finite", [&](GltfBuilder& b) { put_float(b, offset(6), kNan); }},
                         {"does not fit into a float", [](GltfBuilder& b) {
                            b.document["nodes"][2]["translation"] = {1e300, 0, 0};
                          }}});
}

TEST(RefuseAvatar, NamesWhatTheRestPosePutsBeyondAFloat) {
  GltfBuilder chain = one_triangle();
  chain.document["nodes"] = {{{"mesh", 0}}};
  for (int i = 1; i < 9; ++i) chain.document["nodes"].push_back({{"children", {i - 1}}});
  const auto scale_all = [](GltfBuilder& b) {
    for (nlohmann::json& node : b.document["nodes"]) node["scale"] = {1e38, 1e38, 1e38};
  };
  expect_refused(chain, {{"nodes[7]: in the rest pose its global matrix is beyond", scale_all}});
  expect_refused(one_triangle(), {{"nodes[0]: in the rest pose it moves vertex 1 beyond", [](GltfBuilder& b) {
                                     put_float(b, 12, 1e30F);
                                     b.document["nodes"][0]["scale"] = {1e30, 1, 1};
                                   }}});
  GltfBuilder skinned = skinned_triangle();
  const auto inverse_bind = skinned.document["bufferViews"][3]["byteOffset"].get<std::size_t>();
  expect_refused(skinned, {{"nodes[2]: in the rest pose its matrix times its inverse bind matrix", [=](GltfBuilder& b) {
                              put_float(b, inverse_bind + 64 + 52, 1e30F);
                              b.document["nodes"][2]["scale"] = {1, 1e30, 1};
                            }}});
}

TEST(RefuseAvatar, NamesIndicesThatReferToNothing) {
  GltfBuilder sound = skinned_triangle();
  sound.document["meshes"][0]["primitives"][0]["indices"] = sound.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2});
  const std::size_t indices = sound.document["bufferViews"][4]["byteOffset"].get<std::size_t>();
  const std::size_t joints = sound.document["bufferViews"][1]["byteOffset"].get<std::size_t>();
  const auto set = [](const char* list, const char* name, int value) {
    return [=](GltfBuilder& b) { b.document[list][0][name] = value; };
  };
  expect_refused(sound,
                 {{"primitives[0].indices: index 2 is 3", [=](GltfBuilder& b) { b.bin[indices + 2] = std::byte{3}; }},
                  {"JOINTS_0: vertex 1 names joint 2", [=](GltfBuilder& b) { b.bin[joints + 4] = std::byte{2}; }},
                  {"nodes[0].mesh: 1 does not exist: the number of meshes is 1", set("nodes", "mesh", 1)},
                  {"nodes[0].skin: 1 does not exist", set("nodes", "skin", 1)},
                  {"nodes[0].skin: -1 is not a whole number", set("nodes", "skin", -1)},
                  {"skins[0].inverseBindMatrices: 9", set("skins", "inverseBindMatrices", 9)},
                  {"skins[0].skeleton: 9", set("skins", "skeleton", 9)},
                  {"skins[0].joints[1]: 3 does",
                   [](GltfBuilder& b) {
                     b.document["skins"][0]["joints"] = {1, 3};
                   }},
                  {"nodes[0].children[0]: 3", [](GltfBuilder& b) { b.document["nodes"][0]["children"] = {3}; }},
                  {"attributes.POSITION: 77", [](GltfBuilder& b) { attributes(b)["POSITION"] = 77; }},
                  {"scenes[0].nodes[0]: 8",
                   [](GltfBuilder& b) {
                     b.document["scenes"] = {{{"nodes", {8}}}};
                   }},
                  {"scene: 1 does not exist", [](GltfBuilder& b) { b.document["scene"] = 1; }}});
}

TEST(RefuseAvatar, NamesNodesThatAreNoTree) {
  const auto children = [](std::size_t node, const std::vector<int>& list) {
    return [=](GltfBuilder& b) { b.document["nodes"][node]["children"] = list; };
  };
  expect_refused(skinned_triangle(), {{"nodes[2].children: leads back", children(2, {1})},
                                      {"nodes[0].children: leads back", children(0, {0})},
                                      {"nodes[1].children: leads back",
                                       [](GltfBuilder& b) {
                                         // Node 0 only hangs from the cycle of 1 and 2.
                                         b.document["nodes"][1]["children"] = {2, 0};
                                         b.document["nodes"][2]["children"] = {1};
                                       }},
                                      {"nodes[2]: is a child of nodes[0] and again of nodes[1]", children(0, {2})},
                                      {"nodes[2]: is a child of nodes[1] and again of nodes[1]", children(1, {2, 2})},
                                      {"nodes[0].rotation: is zero",
                                       [](GltfBuilder& b) {
                                         b.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
                                       }},
                                      {"nodes[0].rotation: has 3 numbers",
                                       [](GltfBuilder& b) {
                                         b.document["nodes"][0]["rotation"] = {0, 0, 1};
                                       }},
                                      {"nodes[0].matrix: is not an affine", [](GltfBuilder& b) {
                                         b.document["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0,
                                                                             0, 0, 1, 0, 0, 0, 0, 1};
                                       }}});
}

TEST(RefuseAvatar, NamesSkinsThatCannotBe) {
  const auto skin = [](GltfBuilder& b) -> nlohmann::json& { return b.document["skins"][0]; };
  expect_refused(
      skinned_triangle(),
      {{"skins[0].joints: names nodes[1] more than once",
        [&](GltfBuilder& b) {
          skin(b)["joints"] = {1, 1};
        }},
       {"skins[0].joints: is empty", [&](GltfBuilder& b) { skin(b)["joints"] = nlohmann::json::array(); }},
       {"skins[0]: 'joints' is missing", [&](GltfBuilder& b) { skin(b).erase("joints"); }},
       {"has 2 matrices for 3 joints",
        [&](GltfBuilder& b) {
          skin(b)["joints"] = {0, 1, 2};
        }},
       {"is VEC4 of float, but skins[0]", [&](GltfBuilder& b) { skin(b)["inverseBindMatrices"] = 2; }},
       {"byteStride: is 60, but only vertex attributes may be interleaved, not skins[0].inverseBindMatrices",
        [](GltfBuilder& b) { b.document["bufferViews"][3]["byteStride"] = 60; }},
       {"matrix 0 is not affine",
        [](GltfBuilder& b) { put_float(b, b.document["bufferViews"][3]["byteOffset"].get<std::size_t>() + 12, 1); }},
       {"WEIGHTS_0: vertex 0 has the negative weight",
        [](GltfBuilder& b) { put_float(b, b.document["bufferViews"][2]["byteOffset"].get<std::size_t>(), -1); }},
       {"has no JOINTS_0", [](GltfBuilder& b) { attributes(b).erase("JOINTS_0"); }},
       {"WEIGHTS_0: is missing", [](GltfBuilder& b) { attributes(b).erase("WEIGHTS_0"); }},
       {"WEIGHTS_1: is missing", [](GltfBuilder& b) { attributes(b)["JOINTS_1"] = 1; }},
       {"has 2 elements for 3", [](GltfBuilder& b) { b.document["accessors"][2]["count"] = 2; }}});
}

TEST(RefuseAvatar, NamesAnimationsThatCannotBePlayed) {
  GltfBuilder sound = one_triangle();
  test::animate(sound, 0, "rotation", "LINEAR", {0, 1, 2}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1});
  const auto animation = [](GltfBuilder& b) -> nlohmann::json& { return b.document["animations"][0]; };
  const std::size_t times = 36;
  const std::size_t rotations = 48;
  expect_refused(
      sound,
      {{"samplers[0].input: time 1 (0 s) is not later", [=](GltfBuilder& b) { put_float(b, times + 4, 0); }},
       {"samplers[0].input: time 0 is negative", [=](GltfBuilder& b) { put_float(b, times, -1); }},
       {"samplers[0].output: key 0 is zero", [=](GltfBuilder& b) { put_float(b, rotations + 12, 0); }},
       {"channels[0].sampler: 1 does", [&](GltfBuilder& b) { animation(b)["channels"][0]["sampler"] = 1; }},
       {"target.node: 4 does", [&](GltfBuilder& b) { animation(b)["channels"][0]["target"]["node"] = 4; }},
       {"channels[1].target: animates the rotation of nodes[0] a second time",
        [&](GltfBuilder& b) { animation(b)["channels"].push_back(nlohmann::json(animation(b)["channels"][0])); }},
       {"samplers[0].interpolation: 'SMOOTH'",
        [&](GltfBuilder& b) { animation(b)["samplers"][0]["interpolation"] = "SMOOTH"; }},
       {"has 3 elements, but 3 times need 9",
        [&](GltfBuilder& b) { animation(b)["samplers"][0]["interpolation"] = "CUBICSPLINE"; }},
       {"has 3 elements, but 2 times need 2", [](GltfBuilder& b) { b.document["accessors"][1]["count"] = 2; }},
       {"needs VEC3 of float", [&](GltfBuilder& b) { animation(b)["channels"][0]["target"]["path"] = "translation"; }},
       {"a node with a `matrix` cannot be animated",
        [](GltfBuilder& b) { b.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }}});
}

TEST(RefuseAvatar, NamesExtensionsThatItWouldNeed) {
  expect_refused(one_triangle(), {{"KHR_draco_mesh_compression, EXT_mesh_gpu_instancing",
                                   [](GltfBuilder& b) {
                                     b.document["extensionsRequired"] = {"KHR_draco_mesh_compression",
                                                                         "KHR_materials_unlit",
                                                                         "EXT_mesh_gpu_instancing"};
                                   }},
                                  {"meshes[0].primitives[0]: is compressed by KHR_draco_mesh_compression",
                                   [](GltfBuilder& b) {
                                     b.document["accessors"][0].erase("bufferView");
                                     b.document["meshes"][0]["primitives"][0]["extensions"] = {
                                         {"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
                                   }},
                                  {"is glTF 1.0", [](GltfBuilder& b) { b.document["asset"]["version"] = "1.0"; }},
                                  {"at least 2.1", [](GltfBuilder& b) { b.document["asset"]["minVersion"] = "2.1"; }}});
}

TEST(RefuseAvatar, NamesJsonThatSaysTwoThings) {
  const auto with = [](std::string_view before, std::string_view added) {
    const GltfBuilder builder = skinned_triangle();
    nlohmann::json document = builder.document;
    document["buffers"] = {{{"byteLength", builder.bin.size()}}};
    std::string text = document.dump();
    text.insert(text.find(before), added);
    return refusal(test::make_glb(text, builder.bin));
  };
  EXPECT_EQ(with("\"nodes\"", ""), "loaded");
  EXPECT_THAT(with("\"nodes\"", "\"nodes\":[{}],"), HasSubstr("nodes: appears more than once"));
  EXPECT_THAT(with("\"nodes\"", "\"n\\u006fdes\":[{}],"), HasSubstr("nodes: appears more than once"));
  EXPECT_THAT(with("\"mesh\":0", "\"mesh\":1,"), HasSubstr("nodes[0]: has 'mesh' more than once"));
  EXPECT_THAT(with("\"POSITION\"", "\"POSITION\":1,"), HasSubstr("meshes[0]: has 'POSITION' more than once"));
  EXPECT_THAT(with("\"mesh\":0", "\"scale\":[1e400,1,1],"),
              HasSubstr("nodes[0]: the JSON cannot be read: it holds a number too large for a double"));
  EXPECT_THAT(with("\"mesh\":0", "\"name\":\"\\ud800\","),
              HasSubstr("nodes[0]: the JSON cannot be read: it holds half of a surrogate pair"));
  EXPECT_THAT(with("\"version\"", "\"version\":\"2.0\","), HasSubstr("asset: has 'version' more than once"));
  for (const char* broken : {"\"a\":01,", "\"a\":1.,", "\"a\":.5,", "\"a\":+1,", "\"a\":nul,", "\"a\":\"\\x\",",
                             "\"a\":\"\x01\",", "\"a\":\"\xC3\",", "\"a\":\"\xED\xA0\x80\",", "\"a\":[1,],", ",",
                             "a:1,", "\"a\" 1,", "\"a\":NaN,", "\"a\":{\"b\"},", "/**/"})
    EXPECT_THAT(with("\"mesh\":0", broken), HasSubstr("the JSON cannot be read: at its byte")) << broken;
}

TEST(RefuseAvatar, NamesMeshesThatBreakTheRulesOfTheirFormat) {
  GltfBuilder sound = skinned_triangle();
  sound.document["meshes"][0]["primitives"][0]["indices"] = sound.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2});
  sound.add("VEC3", std::vector<float>(6));
  const auto primitive = [](GltfBuilder& b) -> nlohmann::json& { return b.document["meshes"][0]["primitives"][0]; };
  expect_refused(
      sound,
      {{"attributes.TEXCOORD_0: has 2 elements for 3", [](GltfBuilder& b) { attributes(b)["TEXCOORD_0"] = 5; }},
       {"targets[0].POSITION: has 2 elements for 3",
        [&](GltfBuilder& b) {
          primitive(b)["targets"] = {{{"POSITION", 5}}};
        }},
       {"targets[0].POSITION: 99 does not exist",
        [&](GltfBuilder& b) {
          primitive(b)["targets"] = {{{"POSITION", 99}}};
        }},
       {"JOINTS_n whose numbers do not count up", [](GltfBuilder& b) { attributes(b)["JOINTS_2"] = 1; }},
       {"WEIGHTS_n whose numbers do not count up", [](GltfBuilder& b) { attributes(b)["WEIGHTS_2"] = 2; }},
       {"byteStride: 14 is not a multiple of 4",
        [](GltfBuilder& b) { b.document["bufferViews"][0]["byteStride"] = 14; }},
       {"nodes[2].matrix: is given together",
        [](GltfBuilder& b) { b.document["nodes"][2]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
       {"is 4, but only vertex attributes may be interleaved, not meshes[0].primitives[0].indices",
        [](GltfBuilder& b) { b.document["bufferViews"][4]["byteStride"] = 4; }},
       {"meshes[1].primitives[0].indices: index 2 is 7", [=](GltfBuilder& b) {
          // A mesh that nothing shows.
          b.document["meshes"].push_back(b.document["meshes"][0]);
          b.document["meshes"][1]["primitives"][0]["indices"] = b.add("SCALAR", std::vector<std::uint8_t>{0, 1, 7});
        }}});
  GltfBuilder large = one_triangle();
  large.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = large.add("VEC3", std::vector<float>(900));
  large.document["meshes"][0]["primitives"][0]["indices"] = large.add("SCALAR", std::vector<std::uint8_t>{0, 1, 255});
  EXPECT_THAT(refusal(large.glb()), HasSubstr("index 2 is 255, which restarts a primitive"));
}

TEST(RefuseAvatar, SaysSoWhereThereIsNoTriangle) {
  expect_refused(one_triangle(), {{"no triangles",
                                   [](GltfBuilder& b) {
                                     b.document["nodes"] = {{{"name", "empty"}}};
                                   }},
                                  {"no triangles", [](GltfBuilder& b) { b.document.erase("nodes"); }},
                                  {"also: test.glb: meshes[0].primitives[0]: skipped points or lines",
                                   [](GltfBuilder& b) { b.document["meshes"][0]["primitives"][0]["mode"] = 0; }}});
}

TEST(RefuseAvatar, DoesNotLetASmallFileAskForMuchMemory) {
  GltfBuilder builder = one_triangle();
  builder.document["accessors"][0].erase("bufferView");
  builder.document["accessors"][0]["count"] = 100000;
  EXPECT_THAT(refusal(builder.glb()), HasSubstr("100000 elements do not fit into a file of"));
  // A file of a megabyte, whose mesh is shown ten thousand times.
  GltfBuilder crowd;
  crowd.add("VEC3", std::vector<float>(90000));
  crowd.document["meshes"] = one_triangle().document["meshes"];
  for (int i = 0; i < 10000; ++i) crowd.document["nodes"].push_back({{"mesh", 0}});
  EXPECT_THAT(refusal(crowd.glb()), HasSubstr("more than 1518"));
}

TEST(RefuseAvatar, SurvivesDeepNesting) {
  const std::string brackets(1000000, '[');
  for (const std::string& start : {"{\"extras\":" + brackets, "{\"nodes\":" + brackets, "{\"nodes\":[" + brackets})
    EXPECT_THAT(refusal(test::make_glb(start)),
                AllOf(HasSubstr("nested more than"), HasSubstr("remove the deep extras or extensions")));
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"extras\":";
  EXPECT_THAT(refusal(test::make_glb(objects)), HasSubstr("nested more than"));
}

TEST(RefuseAvatar, SurvivesAChainOfManyNodes) {
  GltfBuilder builder = one_triangle();
  constexpr int kCount = 100000;
  for (int i = 1; i < kCount; ++i) builder.document["nodes"].push_back({{"children", {i - 1}}});
  EXPECT_EQ(refusal(builder.glb()), "loaded");
}

TEST(RefuseAvatar, SurvivesAFileCutShortAnywhere) {
  const std::vector<std::byte> glb = skinned_triangle().glb();
  for (std::size_t size = 0; size < glb.size(); ++size)
    EXPECT_THAT(refusal({glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)}), HasSubstr("test.glb: byte"));
}

TEST(RefuseAvatar, SurvivesEveryByteFlipped) {
  GltfBuilder builder = skinned_triangle();
  test::animate(builder, 1, "rotation", "CUBICSPLINE", {0, 1},
                {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  const std::vector<std::byte> glb = builder.glb();
  std::size_t refused = 0;
  for (std::size_t i = 0; i < glb.size(); ++i)
    for (const unsigned mask : {0x01U, 0x04U, 0x10U, 0x80U, 0xFFU}) {
      std::vector<std::byte> broken = glb;
      broken[i] ^= static_cast<std::byte>(mask);
      if (refusal(broken) != "loaded") ++refused;
    }
  EXPECT_GT(refused, glb.size());
}

TEST(RefuseAvatar, NamesWhatIsWrongWithATextFilesBuffers) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "short.bin") << "0123456789";
  const auto refusal_of = [&](const std::string& uri) -> std::string {
    GltfBuilder builder = one_triangle();
    builder.document["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    std::ofstream(folder / "a.gltf") << builder.document.dump();
    try {
      parse_avatar_glb(read_avatar_glb(folder / "a.gltf"), "a.gltf");
    } catch (const Error& error) {
      return error.what();
    }
    return "loaded";
  };
  EXPECT_THAT(refusal_of("short.bin"),
              HasSubstr("a.gltf: buffers[0].byteLength: says 36 bytes, but there are only 10"));
  EXPECT_THAT(refusal_of("missing.bin"), HasSubstr("missing.bin', which does not exist"));
  for (const char* uri : {"../short.bin", "x/../../short.bin", "%2e%2e/short.bin", "..%2Fshort.bin", "/etc/passwd",
                          "%2Fetc/passwd", "..\\short.bin"})
    EXPECT_THAT(refusal_of(uri), HasSubstr("buffers[0].uri: '" + std::string(uri) + "' leaves the folder"));
  for (const char* uri : {"file:///etc/passwd", "http://example.org/a.bin", "c:a.bin"})
    EXPECT_THAT(refusal_of(uri), HasSubstr("is not a file beside the glTF"));
  EXPECT_THAT(refusal_of("a%zz.bin"), HasSubstr("broken %-escape"));
  EXPECT_THAT(refusal_of("a%2"), HasSubstr("broken %-escape"));
  EXPECT_THAT(refusal_of("%00"), HasSubstr("names no file"));
  EXPECT_THAT(refusal_of(""), HasSubstr("names no file"));
  EXPECT_THAT(refusal_of("."), HasSubstr("folder"));
  EXPECT_THAT(refusal_of("data:,h%65llo"), HasSubstr("says 36 bytes, but there are only 5"));
  EXPECT_THAT(refusal_of("data:,h%6"), HasSubstr("broken %-escape"));
  EXPECT_THAT(refusal_of("data:a/b;base64"), HasSubstr("no comma"));
  EXPECT_THAT(refusal_of("data:a/b;base64,AA?A"), HasSubstr("is not a base64 digit"));
  EXPECT_THAT(refusal_of("data:a/b;base64,AAAAA"), HasSubstr("do not make whole bytes"));
  EXPECT_THAT(refusal_of("data:a/b;base64,AAAA"), HasSubstr("says 36 bytes, but there are only 3"));
}

TEST(RefuseAvatar, SaysThatATextFileIsUtf16) {
  for (const char* mark : {"\xFF\xFE{", "\xFE\xFF"}) {
    const auto bytes = std::as_bytes(std::span(mark, 3));
    try {
      pack_avatar_glb({bytes.begin(), bytes.end()}, "a.gltf");
      ADD_FAILURE() << "loaded";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("a.gltf: is UTF-16"), HasSubstr("save the file as UTF-8")));
    }
  }
}

TEST(RefuseAvatar, SaysThatABinaryFileRefersToAnother) {
  GltfBuilder builder = one_triangle();
  builder.document["buffers"] = {{{"byteLength", 36}, {"uri", "a.bin"}}};
  EXPECT_THAT(refusal(builder.glb()), HasSubstr("buffers[0].uri: is in another file"));
}

}  // namespace
}  // namespace vestige
