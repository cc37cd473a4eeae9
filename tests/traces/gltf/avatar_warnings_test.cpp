// What loads with a warning, or without one where none is due.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::attributes;
using test::GltfBuilder;
using test::one_triangle;
using test::parse;
using test::skinned_triangle;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ParseAvatar, TakesRequiredExtensionsThatCannotTouchGeometry) {
  GltfBuilder builder = one_triangle();
  for (const char* name :
       {"KHR_materials_variants", "ADOBE_materials_thin_transparency", "NV_materials_mdl", "MOZ_hubs_components",
        "KHR_environment_map", "EXT_structural_metadata", "EXT_mesh_features", "CESIUM_primitive_outline"})
    builder.document["extensionsRequired"].push_back(name);
  builder.document["extensionsUsed"] = builder.document["extensionsRequired"];
  EXPECT_THAT(parse(builder).warnings, IsEmpty());
}

TEST(ParseAvatar, SaysWhatIsDrawnWhereAnExtensionIsIgnored) {
  GltfBuilder builder = one_triangle();
  builder.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_node_visibility", "X_other"};
  EXPECT_THAT(parse(builder).warnings,
              ElementsAre(HasSubstr("ignored EXT_mesh_gpu_instancing (an instanced mesh is drawn once), "
                                    "KHR_node_visibility (hidden nodes are drawn), X_other")));
}

TEST(ParseAvatar, MergesWarningsThatDifferOnlyInANameTheFileGives) {
  GltfBuilder builder = one_triangle();
  test::animate(builder, 0, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  for (int i = 0; i < 3000; ++i) {
    builder.document["animations"][0]["channels"].push_back(
        {{"sampler", 0}, {"target", {{"node", 0}, {"path", "path " + std::to_string(i)}}}});
    builder.document["extensionsRequired"].push_back("VRMC_" + std::to_string(i));
  }
  EXPECT_THAT(parse(builder).warnings, ElementsAre(HasSubstr("extensionsRequired 'VRMC_0' (and 2999 more)"),
                                                   HasSubstr("channels[1].target.path 'path 0' (and 2999 more)")));
}

TEST(ParseAvatar, IgnoresBoundsBeyondDouble) {
  const GltfBuilder builder = one_triangle();
  nlohmann::json document = builder.document;
  document["buffers"] = {{{"byteLength", builder.bin.size()}}};
  document["accessors"][0].erase("max");
  std::string text = document.dump();
  text.insert(text.find("\"count\""), "\"max\":[1e400,1,0],");
  const Avatar avatar = parse_avatar_glb(test::make_glb(text, builder.bin), "test.glb");
  EXPECT_THAT(avatar.triangles, SizeIs(1));
  EXPECT_THAT(avatar.warnings, Contains(AllOf(HasSubstr("accessors[0].max"), HasSubstr("too large for a double"))));
}

TEST(ParseAvatar, WarnsOnceOfWhatDoesNoHarmAndNamesIt) {
  GltfBuilder builder = one_triangle();
  builder.document["nodes"][0]["colour"] = "green";
  builder.document["nodes"].push_back({{"colour", "red"}});
  builder.document["accessors"][0]["max"] = {2, 1, 0};
  builder.document["accessors"][0]["min"] = {0, 0, 0};
  builder.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  EXPECT_THAT(parse(builder).warnings, ElementsAre(HasSubstr("EXT_mesh_gpu_instancing"),
                                                   HasSubstr("nodes[0].colour (and 1 more): is not a property"),
                                                   HasSubstr("accessors[0].max: is not the maximum")));
}

TEST(ParseAvatar, WarnsOfWhatTheFormatForbidsButCannotBeMistaken) {
  const auto warnings = [](const auto& change) {
    GltfBuilder builder = skinned_triangle();
    change(builder);
    return parse(builder).warnings;
  };
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["nodes"][0]["name"] = 5; }),
              ElementsAre(HasSubstr("nodes[0].name: is not a text")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["accessors"][0].erase("min"); }),
              ElementsAre(HasSubstr("accessors[0]: has no min or no max")));
  EXPECT_THAT(warnings([](GltfBuilder& b) {
                b.document["accessors"][0]["max"] = {1, 1};
              }),
              Contains(HasSubstr("accessors[0].max: does not have as many numbers")));
  EXPECT_THAT(warnings([](GltfBuilder& b) {
                b.document["accessors"][0]["max"] = {1e300, 1, 0};
              }),
              ElementsAre(HasSubstr("accessors[0].max: is not the maximum")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["accessors"][0]["normalized"] = true; }),
              ElementsAre(HasSubstr("accessors[0].normalized: has no meaning for float")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { attributes(b)["COLOUR"] = 0; }),
              ElementsAre(HasSubstr("attributes.COLOUR: is not an attribute")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { attributes(b)["NORMAL"] = b.add("VEC3", std::vector<float>(6)); }),
              ElementsAre(HasSubstr("attributes.NORMAL: does not have one element for each vertex, and is not read")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["nodes"][1]["skin"] = 0; }),
              ElementsAre(HasSubstr("nodes[1].skin: has no effect without a mesh")));
  EXPECT_THAT(warnings([](GltfBuilder& b) {
                b.document["scenes"] = {{{"nodes", {0, 1, 1}}}};
              }),
              ElementsAre(HasSubstr("scenes[0].nodes: names a node twice")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["extensionsRequired"] = {"VRM"}; }),
              ElementsAre(HasSubstr("extensionsRequired 'VRM': is not in extensionsUsed")));
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["bufferViews"][0]["target"] = "vertices"; }), IsEmpty());
  EXPECT_THAT(warnings([](GltfBuilder& b) { b.document["nodes"][0]["mesh"] = 0.0; }),
              ElementsAre(HasSubstr("nodes[0].mesh: is a whole number written as a decimal")));
}

TEST(ParseAvatar, AcceptsWholeNumbersWrittenAsDecimals) {
  GltfBuilder builder = one_triangle();
  builder.document["accessors"][0]["count"] = 3.0;
  builder.document["nodes"][0]["mesh"] = 0.0;
  EXPECT_THAT(parse(builder).triangles, SizeIs(1));
}

}  // namespace
}  // namespace vestige
