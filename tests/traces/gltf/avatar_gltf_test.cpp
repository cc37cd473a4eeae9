#include "traces/gltf/avatar_gltf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

using test::attributes;
using test::GltfBuilder;
using test::one_triangle;
using test::parse;
using test::primitive;
using test::skinned_triangle;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ParseAvatar, ReadsASkinnedTriangle) {
  const Avatar avatar = parse(skinned_triangle());
  EXPECT_THAT(avatar.warnings, IsEmpty());
  EXPECT_THAT(avatar.position_bind, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(avatar.texture_coordinate, ElementsAre(glm::vec2(0), glm::vec2(0), glm::vec2(0)));
  EXPECT_THAT(avatar.triangles, ElementsAre(glm::uvec3(0, 1, 2)));
  ASSERT_EQ(avatar.palette.size(), 2U);
  EXPECT_EQ(avatar.palette[0].node, 1);
  EXPECT_EQ(avatar.palette[1].node, 2);
  EXPECT_EQ(avatar.palette[1].inverse_bind[3], glm::dvec4(0, -1, 0, 1));
  EXPECT_EQ(avatar.influences[2].palette[0], 1);
  EXPECT_EQ(avatar.influences[2].weight[0], 1);
  EXPECT_EQ(avatar.influence_count, 1U);
  EXPECT_EQ(avatar.joint_count, 2U);
  EXPECT_EQ(avatar.root_node, 1);
}

TEST(ParseAvatar, LetsAMeshWithoutSkinFollowItsNode) {
  GltfBuilder builder = one_triangle();
  builder.document["nodes"] = {{{"children", {1}}, {"translation", {0, 0, 5}}}, {{"mesh", 0}}};
  const Avatar avatar = parse(builder);
  ASSERT_EQ(avatar.palette.size(), 1U);
  EXPECT_EQ(avatar.palette[0].node, 1);
  EXPECT_EQ(avatar.palette[0].inverse_bind, glm::dmat4(1.0));
  EXPECT_EQ(avatar.root_node, 1);
  EXPECT_EQ(avatar.joint_count, 0U);
  std::vector<glm::dvec3> positions;
  skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), positions);
  EXPECT_EQ(positions[1], glm::dvec3(1, 0, 5));
}

TEST(ParseAvatar, GivesEveryNodeThatShowsAMeshItsOwnVertices) {
  GltfBuilder builder = one_triangle();
  builder.document["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.palette, SizeIs(2));
  EXPECT_THAT(avatar.position_bind, SizeIs(6));
  EXPECT_THAT(avatar.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 5)));
}

TEST(ParseAvatar, SharesVerticesAndPaletteBetweenPrimitivesAndNodesOfOneSkin) {
  GltfBuilder builder = skinned_triangle();
  nlohmann::json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  builder.document["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.position_bind, SizeIs(3));
  EXPECT_THAT(avatar.palette, SizeIs(2));
  EXPECT_THAT(avatar.triangles, SizeIs(4));
}

TEST(ParseAvatar, NumbersTrianglesByNodeThenPrimitiveThenIndex) {
  GltfBuilder builder = one_triangle();
  const std::size_t forward = builder.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 1, 2, 0});
  const std::size_t backward = builder.add("SCALAR", std::vector<std::uint16_t>{2, 1, 0});
  builder.document["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", backward}}}}},
                                {{"primitives",
                                  {{{"attributes", {{"POSITION", 0}}}, {"indices", forward}},
                                   {{"attributes", {{"POSITION", 0}}}, {"indices", backward}}}}}};
  // The scene names the second node first; the order is that of the nodes all the same.
  builder.document["nodes"] = {{{"mesh", 1}}, {{"mesh", 0}}};
  builder.document["scenes"] = {{{"nodes", {1, 0}}}};
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 2, 0), glm::uvec3(2, 1, 0), glm::uvec3(5, 4, 3)));
}

TEST(ParseAvatar, KeepsDegenerateAndDuplicateTriangles) {
  GltfBuilder builder = one_triangle();
  primitive(builder)["indices"] = builder.add("SCALAR", std::vector<std::uint32_t>{0, 0, 0, 0, 1, 2, 0, 1, 2});
  EXPECT_THAT(parse(builder).triangles, SizeIs(3));
}

TEST(ParseAvatar, WindsStripsAndFansAsGltfSays) {
  GltfBuilder builder = one_triangle();
  primitive(builder)["indices"] = builder.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 0, 1});
  primitive(builder)["mode"] = 5;
  EXPECT_THAT(parse(builder).triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 0, 2), glm::uvec3(2, 0, 1)));
  primitive(builder)["mode"] = 6;
  EXPECT_THAT(parse(builder).triangles, ElementsAre(glm::uvec3(1, 2, 0), glm::uvec3(2, 0, 0), glm::uvec3(0, 1, 0)));
}

TEST(ParseAvatar, SkipsPointsAndLinesWithAWarning) {
  GltfBuilder builder = one_triangle();
  nlohmann::json& primitives = builder.document["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[0]["mode"] = 1;
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.triangles, SizeIs(1));
  EXPECT_THAT(avatar.warnings, ElementsAre(HasSubstr("test.glb: meshes[0].primitives[0]: skipped points or lines")));
}

TEST(ParseAvatar, DrawsOnlyTheDefaultScene) {
  GltfBuilder builder = one_triangle();
  builder.document["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(parse(builder).triangles, SizeIs(2)) << "no scenes: all nodes";
  builder.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 1}}}};
  EXPECT_THAT(parse(builder).triangles, SizeIs(1)) << "no default: the first scene";
  builder.document["scene"] = 1;
  EXPECT_THAT(parse(builder).triangles, SizeIs(2));
}

TEST(ParseAvatar, IgnoresTheTransformOfASkinnedNodeAndItsParents) {
  GltfBuilder builder = skinned_triangle();
  builder.document["nodes"][0]["scale"] = {7, 7, 7};
  builder.document["nodes"].push_back({{"children", {0}}, {"translation", {9, 9, 9}}});
  const Avatar avatar = parse(builder);
  std::vector<glm::dvec3> positions;
  skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), positions);
  EXPECT_EQ(positions[1], glm::dvec3(1, 0, 0));
}

TEST(ParseAvatar, TakesTheIdentityWhereInverseBindMatricesAreMissing) {
  GltfBuilder builder = skinned_triangle();
  builder.document["skins"][0].erase("inverseBindMatrices");
  EXPECT_EQ(parse(builder).palette[1].inverse_bind, glm::dmat4(1.0));
}

TEST(ParseAvatar, KeepsOnePaletteEntryForEachJointAndInverseBind) {
  GltfBuilder builder = skinned_triangle();
  builder.document["skins"].push_back({{"joints", {2, 1}}});
  builder.document["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  const Avatar avatar = parse(builder);
  // Joint 1 has the identity in both skins; joint 2 does not.
  ASSERT_THAT(avatar.palette, SizeIs(3));
  EXPECT_EQ(avatar.palette[2].node, 2);
  EXPECT_EQ(avatar.influences[3].palette[0], 2) << "the second skin counts its joints in its own order";
  EXPECT_EQ(avatar.influences[5].palette[0], 0);
  EXPECT_EQ(avatar.joint_count, 2U);
}

TEST(ParseAvatar, SortsMergesAndNormalisesInfluences) {
  GltfBuilder builder = skinned_triangle();
  attributes(builder)["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint16_t>{1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  attributes(builder)["WEIGHTS_0"] = builder.add("VEC4", std::vector<float>{1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const Avatar avatar = parse(builder);
  EXPECT_EQ(avatar.influences[0].palette, (std::array<std::uint16_t, 8>{0, 1}));
  EXPECT_EQ(avatar.influences[0].weight,
            (std::array<float, 8>{static_cast<float>(1 / 3.0), static_cast<float>(2 / 3.0)}));
  EXPECT_EQ(avatar.influence_count, 2U);
  EXPECT_THAT(avatar.warnings,
              ElementsAre(HasSubstr("names a joint twice"), AllOf(HasSubstr("WEIGHTS_0"), HasSubstr("sum is not 1"))));
}

TEST(ParseAvatar, ReadsNormalisedWeights) {
  GltfBuilder builder = skinned_triangle();
  attributes(builder)["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint8_t>{0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::size_t bytes = builder.add("VEC4", std::vector<std::uint8_t>{51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0});
  builder.document["accessors"][bytes]["normalized"] = true;
  attributes(builder)["WEIGHTS_0"] = bytes;
  const Avatar avatar = parse(builder);
  EXPECT_EQ(avatar.influences[0].weight[0], 0.2F);
  EXPECT_EQ(avatar.influences[0].weight[1], 0.8F);
  EXPECT_THAT(avatar.warnings, IsEmpty());
}

TEST(ParseAvatar, LetsAVertexWithoutWeightsFollowItsFirstJoint) {
  GltfBuilder builder = skinned_triangle();
  attributes(builder)["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  attributes(builder)["WEIGHTS_0"] = builder.add("VEC4", std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const Avatar avatar = parse(builder);
  EXPECT_EQ(avatar.influences[0].palette[0], 1);
  EXPECT_EQ(avatar.influences[0].weight[0], 1);
  EXPECT_THAT(avatar.warnings, ElementsAre(HasSubstr("without any weight")));
}

TEST(ParseAvatar, KeepsTheEightLargestOfTwelveWeights) {
  GltfBuilder builder = skinned_triangle();
  nlohmann::json joints = nlohmann::json::array();
  for (int joint = 0; joint < 12; ++joint) {
    builder.document["nodes"].push_back({{"name", "joint"}});
    joints.push_back(3 + joint);
  }
  builder.document["skins"] = {{{"joints", joints}}};
  for (std::uint8_t set = 0; set < 3; ++set) {
    std::vector<std::uint8_t> numbers;
    std::vector<float> weights;
    for (int vertex = 0; vertex < 3; ++vertex)
      for (std::uint8_t c = 0; c < 4; ++c) {
        numbers.push_back(static_cast<std::uint8_t>(4 * set + c));
        weights.push_back(static_cast<float>(4 * set + c + 1) / 78);
      }
    attributes(builder)["JOINTS_" + std::to_string(set)] = builder.add("VEC4", numbers);
    attributes(builder)["WEIGHTS_" + std::to_string(set)] = builder.add("VEC4", weights);
  }
  const Avatar avatar = parse(builder);
  EXPECT_EQ(avatar.influence_count, 8U);
  EXPECT_EQ(avatar.influences[0].palette, (std::array<std::uint16_t, 8>{4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_FLOAT_EQ(avatar.influences[0].weight[0], 5.0F / 68);
  EXPECT_THAT(avatar.warnings, Contains(HasSubstr("more than 8 joints")));
}

TEST(ParseAvatar, IgnoresJointsThatDoNotExistButWeighNothing) {
  GltfBuilder builder = skinned_triangle();
  attributes(builder)["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint8_t>{0, 9, 9, 9, 0, 9, 9, 9, 1, 9, 9, 9});
  const Avatar avatar = parse(builder);
  EXPECT_EQ(avatar.influences[2].palette[0], 1);
  EXPECT_THAT(avatar.warnings, ElementsAre(HasSubstr("do not exist")));
}

TEST(ParseAvatar, ReadsInterleavedAttributes) {
  GltfBuilder builder = one_triangle();
  // Position and texture coordinates take turns: five floats a vertex.
  builder.bin.clear();
  builder.document.erase("accessors");
  builder.document.erase("bufferViews");
  builder.add("SCALAR", std::vector<float>{0, 0, 0, 0.25F, 0.5F, 1, 0, 0, 0.75F, 1, 0, 1, 0, 0, 0});
  builder.document["bufferViews"][0]["byteStride"] = 20;
  builder.document["accessors"] = {
      {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
      {{"bufferView", 0}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}};
  attributes(builder) = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.position_bind, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(avatar.texture_coordinate, ElementsAre(glm::vec2(0.25F, 0.5F), glm::vec2(0.75F, 1), glm::vec2(0)));
}

TEST(ParseAvatar, ReadsQuantisedPositionsOnlyWhereTheFileDeclaresThem) {
  GltfBuilder builder = one_triangle();
  const std::size_t quantised = builder.add("VEC3", std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, -32768, 0});
  attributes(builder)["POSITION"] = quantised;
  EXPECT_THROW(parse(builder), Error);
  builder.document["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(parse(builder).position_bind[2], glm::vec3(0, -32768, 0));
  builder.document["accessors"][quantised]["normalized"] = true;
  EXPECT_EQ(parse(builder).position_bind[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(parse(builder).position_bind[2], glm::vec3(0, -1, 0));
}

TEST(ParseAvatar, SubstitutesSparseElementsWithAndWithoutABaseBuffer) {
  GltfBuilder builder = one_triangle();
  builder.add("SCALAR", std::vector<std::uint8_t>{1, 2});
  builder.add("VEC3", std::vector<float>{5, 0, 0, 0, 5, 0});
  nlohmann::json& position = builder.document["accessors"][0];
  position["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", 1}, {"componentType", 5121}}}, {"values", {{"bufferView", 2}}}};
  EXPECT_THAT(parse(builder).position_bind, ElementsAre(glm::vec3(0), glm::vec3(5, 0, 0), glm::vec3(0, 5, 0)));
  position["sparse"]["count"] = 1;
  EXPECT_THAT(parse(builder).position_bind, ElementsAre(glm::vec3(0), glm::vec3(5, 0, 0), glm::vec3(0, 1, 0)));
  position.erase("bufferView");
  EXPECT_THAT(parse(builder).position_bind, ElementsAre(glm::vec3(0), glm::vec3(5, 0, 0), glm::vec3(0)));
}

TEST(ParseAvatar, DecomposesAMatrixAndKeepsOneThatIsNoProduct) {
  GltfBuilder builder = one_triangle();
  // Mirrored, turned by 90 degrees about z, scaled by 2, 3, 4, moved by 5, 6, 7.
  builder.document["nodes"][0]["matrix"] = {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
  const Avatar product = parse(builder);
  EXPECT_FALSE(product.nodes[0].fixed_matrix.has_value());
  std::vector<glm::dmat4> world;
  world_matrices(product, rest_pose(product), world);
  EXPECT_NEAR(world[0][0].y, -2, 1e-6);
  EXPECT_NEAR(world[0][1].x, -3, 1e-6);
  EXPECT_NEAR(world[0][3].z, 7, 1e-6);

  builder.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const Avatar sheared = parse(builder);
  ASSERT_TRUE(sheared.nodes[0].fixed_matrix.has_value());
  EXPECT_EQ((*sheared.nodes[0].fixed_matrix)[1].x, 0.5);

  builder.document["nodes"][0]["matrix"] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_TRUE(parse(builder).nodes[0].fixed_matrix.has_value()) << "flat: no rotation can be told from it";
}

TEST(ParseAvatar, OrdersParentsBeforeChildren) {
  GltfBuilder builder = one_triangle();
  builder.document["nodes"] = {{{"mesh", 0}}, {{"children", {0}}}, {{"children", {1}}}};
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.node_order, ElementsAre(2, 1, 0));
  EXPECT_EQ(avatar.nodes[0].parent, 1);
  EXPECT_EQ(avatar.nodes[2].parent, -1);
}

TEST(ParseAvatar, ReadsAnimationsWithoutMinAndMax) {
  GltfBuilder builder = one_triangle();
  test::animate(builder, 0, "translation", "STEP", {0.5, 1.5}, {0, 0, 0, 1, 0, 0});
  builder.document["animations"][0]["name"] = "jump";
  const Avatar avatar = parse(builder);
  ASSERT_THAT(avatar.animations, SizeIs(1));
  EXPECT_EQ(avatar.animations[0].name, "jump");
  EXPECT_EQ(avatar.animations[0].duration_s, 1.5);
  ASSERT_THAT(avatar.animations[0].channels, SizeIs(1));
  EXPECT_EQ(avatar.animations[0].channels[0].interpolation, Interpolation::kStep);
  EXPECT_EQ(avatar.animations[0].channels[0].property, AnimatedProperty::kTranslation);
  EXPECT_THAT(avatar.animations[0].channels[0].values, ElementsAre(0, 0, 0, 1, 0, 0));
}

TEST(ParseAvatar, ReadsNormalisedRotations) {
  GltfBuilder builder = one_triangle();
  test::animate(builder, 0, "rotation", "LINEAR", {0}, {0, 0, 0, 1});
  const std::size_t quantised = builder.add("VEC4", std::vector<std::int16_t>{0, 0, 32767, 0});
  builder.document["accessors"][quantised]["normalized"] = true;
  builder.document["animations"][0]["samplers"][0]["output"] = quantised;
  EXPECT_THAT(parse(builder).animations[0].channels[0].values, ElementsAre(0, 0, 1, 0));
}

TEST(ParseAvatar, IgnoresChannelsThatMoveNoNode) {
  GltfBuilder builder = one_triangle();
  test::animate(builder, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  nlohmann::json& channels = builder.document["animations"][0]["channels"];
  const nlohmann::json without_node = {{"sampler", 0}, {"target", {{"path", "translation"}}}};
  channels.insert(channels.begin(), without_node);
  channels.push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
  const Avatar avatar = parse(builder);
  EXPECT_THAT(avatar.animations[0].channels, SizeIs(1));
  EXPECT_THAT(avatar.warnings, Contains(HasSubstr("animations[0].channels[0].target: names no node")));
  EXPECT_THAT(avatar.warnings, Contains(AllOf(HasSubstr("channels[2]"), HasSubstr("'weights'"))));
}

TEST(ParseAvatar, NeverLooksAtImagesMaterialsAndExtras) {
  GltfBuilder builder = one_triangle();
  builder.document["images"] = {{{"uri", "../../no/such/file.png"}}, {{"bufferView", 99}}, 7};
  builder.document["textures"] = {{{"source", 5}}};
  builder.document["materials"] = "none";
  builder.document["cameras"] = {1, 2};
  builder.document["extras"] = {{"anything", {1, {2, {3}}}}};
  primitive(builder)["material"] = 12;
  builder.document["nodes"][0]["camera"] = 3;
  builder.document["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform", "VRM"};
  builder.document["extensionsUsed"] = builder.document["extensionsRequired"];
  builder.document["asset"]["extras"] = {{"author", "x"}};
  builder.document["asset"]["extensions"] = {{"KHR_xmp_json_ld", {{"packet", 0}}}};
  EXPECT_THAT(parse(builder).warnings, IsEmpty());
}

TEST(ParseAvatar, SaysNothingOfExtrasAndExtensionsInsideASparseAccessor) {
  GltfBuilder builder = one_triangle();
  builder.add("SCALAR", std::vector<std::uint8_t>{1});
  builder.add("VEC3", std::vector<float>{1, 0, 0});
  const nlohmann::json extra = {{"X_y", 1}};
  builder.document["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", 1}, {"componentType", 5121}, {"extensions", extra}, {"extras", extra}}},
      {"values", {{"bufferView", 2}, {"extensions", extra}, {"extras", extra}}}};
  EXPECT_THAT(parse(builder).warnings, IsEmpty());
}

}  // namespace
}  // namespace vestige
