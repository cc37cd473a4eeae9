// Morph targets: what rests is baked into the positions, what moves is named.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>

#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::attributes;
using test::GltfBuilder;
using test::one_triangle;
using test::parse;
using test::primitive;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Two targets: the first raises vertex 1 by 3 along y, and the second, which is sparse, vertex 2 by 0.5 along x. The
/// first also has normals, which nothing reads.
GltfBuilder& add_targets(GltfBuilder& builder) {
  const std::size_t up = builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 3, 0, 0, 0, 0});
  builder.add("SCALAR", std::vector<std::uint8_t>{2});
  builder.add("VEC3", std::vector<float>{0.5F, 0, 0});
  nlohmann::json& accessors = builder.document["accessors"];
  const std::size_t views = builder.document["bufferViews"].size();
  accessors.push_back({{"componentType", 5126},
                       {"count", 3},
                       {"type", "VEC3"},
                       {"sparse",
                        {{"count", 1},
                         {"indices", {{"bufferView", views - 2}, {"componentType", 5121}}},
                         {"values", {{"bufferView", views - 1}}}}}});
  primitive(builder)["targets"] = {{{"POSITION", up}, {"NORMAL", up}}, {{"POSITION", accessors.size() - 1}}};
  return builder;
}

/// Adds an animation of the weights of node 0; returns the builder, for chaining.
GltfBuilder& animate_weights(GltfBuilder& builder, std::string_view interpolation, const std::vector<float>& times_s,
                             const std::vector<float>& weights) {
  const std::size_t input = builder.add("SCALAR", times_s);
  const std::size_t output = builder.add("SCALAR", weights);
  builder.document["animations"].push_back(
      {{"name", "smile"},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
  return builder;
}

GltfBuilder morphed_triangle() {
  GltfBuilder builder = one_triangle();
  return add_targets(builder);
}

std::string refusal(const GltfBuilder& builder) {
  try {
    parse(builder);
  } catch (const Error& error) {
    return error.what();
  }
  return "loaded";
}

TEST(MorphTargets, AreBakedByTheWeightsOfTheMeshOrOfItsNode) {
  GltfBuilder builder = morphed_triangle();
  EXPECT_EQ(parse(builder).position_bind, parse(one_triangle()).position_bind) << "without weights they rest";
  EXPECT_THAT(parse(builder).warnings, IsEmpty());
  builder.document["meshes"][0]["weights"] = {0.5, 1};
  EXPECT_THAT(parse(builder).position_bind,
              ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 1.5F, 0), glm::vec3(0.5F, 1, 0)));
  EXPECT_THAT(parse(builder).warnings, IsEmpty());
  builder.document["nodes"][0]["weights"] = {0, -2};
  EXPECT_THAT(parse(builder).position_bind, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(-1, 1, 0)));
}

TEST(MorphTargets, AreBakedTheSameWhereTheFileIsPacked) {
  GltfBuilder builder = morphed_triangle();
  builder.document["meshes"][0]["weights"] = {0.3, 0.7};
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(builder.bin.data()), static_cast<std::streamsize>(builder.bin.size()));
  nlohmann::json document = builder.document;
  document["buffers"] = {{{"byteLength", builder.bin.size()}, {"uri", "a.bin"}}};
  std::ofstream(folder / "a.gltf") << document.dump();
  const std::vector<glm::vec3> positions = parse_avatar_glb(read_avatar_glb(folder / "a.gltf"), "a").position_bind;
  EXPECT_EQ(positions, parse(builder).position_bind);
  EXPECT_NE(positions, parse(one_triangle()).position_bind);
}

TEST(MorphTargets, OfOneMeshRestDifferentlyInEachNode) {
  GltfBuilder builder = test::skinned_triangle();
  add_targets(builder);
  builder.document["nodes"].push_back(builder.document["nodes"][0]);
  EXPECT_EQ(parse(builder).position_bind.size(), 3U) << "two nodes share their vertices";
  builder.document["nodes"][0]["weights"] = {1, 0};
  const Avatar avatar = parse(builder);
  ASSERT_EQ(avatar.position_bind.size(), 6U);
  EXPECT_EQ(avatar.position_bind[1], glm::vec3(1, 3, 0));
  EXPECT_EQ(avatar.position_bind[4], glm::vec3(1, 0, 0));
  EXPECT_THAT(avatar.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 5)));
}

TEST(MorphTargets, AreRefusedWhereTheyWouldMoveTheSkinWrongly) {
  const auto with = [](const std::function<void(GltfBuilder&)>& change) {
    GltfBuilder builder = morphed_triangle();
    builder.document["meshes"][0]["weights"] = {1, 1};
    change(builder);
    return builder;
  };
  EXPECT_EQ(refusal(with([](GltfBuilder&) {})), "loaded");
  EXPECT_THAT(refusal(with([](GltfBuilder& b) { b.document["meshes"][0]["weights"] = {1}; })),
              HasSubstr("test.glb: meshes[0].weights: has 1 numbers, but meshes[0].primitives[0] has 2 morph targets"));
  EXPECT_THAT(refusal(with([](GltfBuilder& b) {
                b.document["nodes"][0]["weights"] = {0, 0, 1};
              })),
              HasSubstr("nodes[0].weights: has 3 numbers"));
  EXPECT_THAT(refusal(with([](GltfBuilder& b) { primitive(b)["targets"][1]["POSITION"] = 2; })),
              HasSubstr("targets[1].POSITION: has 1 elements for 3 vertices"));
  const auto put = [](GltfBuilder& b, float value) {
    std::memcpy(b.bin.data() + b.document["bufferViews"][1]["byteOffset"].get<std::size_t>() + 16, &value, 4);
  };
  EXPECT_THAT(refusal(with([&](GltfBuilder& b) { put(b, std::numeric_limits<float>::quiet_NaN()); })),
              HasSubstr("element 1 of meshes[0].primitives[0].targets[0].POSITION is not finite"));
  EXPECT_THAT(refusal(with([&](GltfBuilder& b) {
                put(b, 3e38F);
                b.document["meshes"][0]["weights"] = {2, 0};
              })),
              HasSubstr("meshes[0].primitives[0].targets: move vertex 1 beyond the range of a float"));
  EXPECT_THAT(parse(with([](GltfBuilder& b) { b.document["meshes"][0]["weights"] = {0}; })).warnings,
              ElementsAre(HasSubstr("meshes[0].weights: does not have a number for each morph target")));
}

TEST(MorphTargets, ThatMoveAreNamedWithHowFarTheyGo) {
  GltfBuilder builder = morphed_triangle();
  builder.document["meshes"][0]["weights"] = {0.5, 0};
  builder.document["nodes"][0]["scale"] = {2, 2, 2};
  test::animate(builder, 0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  animate_weights(builder, "LINEAR", {0, 1}, {0.5, 0, 0.75, 0.25});
  const Avatar avatar = parse(builder);
  EXPECT_FALSE(avatar.animations[0].morph) << "an animation of nodes alone";
  ASSERT_TRUE(avatar.animations[1].morph);
  EXPECT_EQ(avatar.animations[1].morph->where, "test.glb: animations[1].channels[0]");
  EXPECT_EQ(avatar.animations[1].morph->reach_m, 2 * 0.25 * 3) << "vertex 1, scaled by its node";
  EXPECT_THAT(avatar.animations[1].channels, IsEmpty());
  EXPECT_THAT(avatar.warnings, IsEmpty());
}

TEST(MorphTargets, OfOneVertexAddUp) {
  GltfBuilder builder = morphed_triangle();
  primitive(builder)["targets"][1] = primitive(builder)["targets"][0];
  animate_weights(builder, "STEP", {0, 1, 2}, {0, 0, 1, 0, 0, -2});
  EXPECT_EQ(parse(builder).animations[0].morph->reach_m, 9) << "an upper bound: never both at once";
}

TEST(MorphTargets, OfASplineCountTheirTangents) {
  GltfBuilder builder = morphed_triangle();
  // Both keys are at rest; between them, at 0.5 s, the tangents lift the first weight to 1.
  animate_weights(builder, "CUBICSPLINE", {0, 1}, {0, 0, 0, 0, 4, 0, -4, 0, 0, 0, 0, 0});
  const double reach_m = parse(builder).animations[0].morph->reach_m;
  EXPECT_GE(reach_m, 3);
  EXPECT_LT(reach_m, 4);
}

TEST(MorphTargets, ThatStayAtRestOrMoveNoVertexAreNoMotion) {
  GltfBuilder builder = morphed_triangle();
  builder.document["meshes"][0]["weights"] = {0.3, 0.7};
  animate_weights(builder, "LINEAR", {0, 1}, {0.3F, 0.7F, 0.3F, 0.7F});
  EXPECT_FALSE(parse(builder).animations[0].morph);

  GltfBuilder only_normals = morphed_triangle();
  for (nlohmann::json& target : primitive(only_normals)["targets"]) target = {{"NORMAL", 1}};
  animate_weights(only_normals, "LINEAR", {0, 1}, {0, 0, 1, 1});
  EXPECT_FALSE(parse(only_normals).animations[0].morph);

  GltfBuilder unseen = morphed_triangle();
  unseen.document["nodes"].push_back({{"mesh", 0}});
  unseen.document["scenes"] = {{{"nodes", {1}}}};
  animate_weights(unseen, "LINEAR", {0, 1}, {0, 0, 1, 1});
  EXPECT_FALSE(parse(unseen).animations[0].morph) << "the node is not drawn";
}

TEST(MorphTargets, WhoseAnimationIsBrokenAreRefused) {
  GltfBuilder builder = morphed_triangle();
  animate_weights(builder, "LINEAR", {0, 1}, {0, 0, 1});
  EXPECT_THAT(refusal(builder), HasSubstr("samplers[0].output: has 3 elements, but 2 times need 4"));

  GltfBuilder two = morphed_triangle();
  animate_weights(two, "LINEAR", {0, 1}, {0, 0, 1, 1});
  nlohmann::json& primitives = two.document["meshes"][0]["primitives"];
  primitives.push_back(nlohmann::json(primitives[0]));
  EXPECT_EQ(refusal(two), "loaded");
  primitives[1]["targets"].erase(1);
  EXPECT_THAT(refusal(two), HasSubstr("meshes[0].primitives[1].targets: are 1, but another primitive of the mesh"));
}

TEST(MorphTargets, OfASmallFileCannotAskForMuch) {
  GltfBuilder deep;
  deep.add("VEC3", std::vector<float>(90000));
  deep.document["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
  deep.document["nodes"] = {{{"mesh", 0}}};
  for (int i = 0; i < 5000; ++i) {
    primitive(deep)["targets"].push_back({{"POSITION", 0}});
    deep.document["meshes"][0]["weights"].push_back(1);
  }
  EXPECT_THAT(refusal(deep), HasSubstr("brings the morph targets to more than"));
  GltfBuilder wide = morphed_triangle();
  for (int i = 0; i < 5000; ++i) primitive(wide)["targets"].push_back({{"POSITION", 1}});
  for (int i = 0; i < 500; ++i) wide.document["nodes"].push_back({{"mesh", 0}});
  EXPECT_THAT(refusal(wide), HasSubstr("bring the avatar to more than"));
}

}  // namespace
}  // namespace vestige
