// Avatars written anew, judged by the Khronos glTF validator (npm's gltf-validator), and read again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/npm.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/clean/clean_avatar.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

using nlohmann::json;
using test::attributes;
using test::GltfBuilder;
using ::testing::IsEmpty;

void expect_no_errors(const std::vector<std::byte>& glb) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  const json issues = json::parse(test::run_node("validate_gltf.mjs", folder / "a.glb"));
  EXPECT_EQ(issues["numErrors"], 0) << issues.dump(2);
}

/// The largest distance between two avatars' vertices, at rest and in every animation.
double difference_m(const Avatar& a, const Avatar& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.texture_coordinate, b.texture_coordinate);
  std::vector<std::pair<Pose, Pose>> poses = {{rest_pose(a), rest_pose(b)}};
  const auto moves = [](const Avatar& avatar) {
    std::vector<const Animation*> moving;
    for (const Animation& animation : avatar.animations)
      if (!animation.channels.empty()) moving.push_back(&animation);
    return moving;
  };
  EXPECT_EQ(moves(a).size(), b.animations.size());
  for (std::size_t i = 0; i < b.animations.size(); ++i)
    for (const double share : {0.0, 0.3, 0.7})
      poses.emplace_back(sample_animation(a, *moves(a)[i], share * moves(a)[i]->duration_s),
                         sample_animation(b, b.animations[i], share * b.animations[i].duration_s));
  double most_m = 0;
  for (const auto& [pose_a, pose_b] : poses) {
    std::vector<glm::dvec3> at_a;
    std::vector<glm::dvec3> at_b;
    skin_reference(a, pose_a, glm::dvec3(0), at_a);
    skin_reference(b, pose_b, glm::dvec3(0), at_b);
    EXPECT_EQ(at_a.size(), at_b.size());
    for (std::size_t i = 0; i < at_a.size(); ++i) most_m = std::max(most_m, glm::distance(at_a[i], at_b[i]));
  }
  return most_m;
}

/// Writes the avatar anew and returns by how much its skin then differs.
double clean_difference_m(const std::vector<std::byte>& glb) {
  const std::vector<std::byte> clean = clean_avatar_glb(glb, "a.glb");
  expect_no_errors(clean);
  const Avatar before = parse_avatar_glb(glb, "a.glb");
  const Avatar after = parse_avatar_glb(clean, "clean.glb");
  EXPECT_THAT(after.warnings, IsEmpty());
  EXPECT_EQ(after.root_node, before.root_node);
  EXPECT_EQ(after.joint_count, before.joint_count);
  EXPECT_EQ(clean_avatar_glb(clean, "clean.glb"), clean) << "there is nothing left to clean";
  return difference_m(before, after);
}

struct Variant {
  const char* name;
  std::function<void(GltfBuilder&)> change;
  double tolerance_m = 0;
};

std::ostream& operator<<(std::ostream& out, const Variant& variant) {
  return out << variant.name;
}

json& accessor(GltfBuilder& b, std::size_t index) {
  return b.document["accessors"][index];
}

void set_weights(GltfBuilder& b, std::size_t first, const std::vector<float>& weights) {
  const auto offset = b.document["bufferViews"][2]["byteOffset"].get<std::size_t>();
  std::memcpy(b.bin.data() + offset + first * sizeof(float), weights.data(), weights.size() * sizeof(float));
}

void add_normals(GltfBuilder& b, const std::vector<float>& normals) {
  attributes(b)["NORMAL"] = b.add("VEC3", normals);
  accessor(b, attributes(b)["NORMAL"]).erase("min");
  accessor(b, attributes(b)["NORMAL"]).erase("max");
}

/// Each is accepted, and wrong in a way that the Khronos validator calls an error.
const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"normals of another count",
       [](GltfBuilder& b) {
         add_normals(b, {0, 0, 1, 0, 0, 1});
       }},
      {"weights",
       [](GltfBuilder& b) {
         set_weights(b, 0, {0.5F, 0.25F, 0, 0, 7, 5, 0, 0});
       },
       1e-6},
      {"weights slightly off",
       [](GltfBuilder& b) {
         set_weights(b, 0, {0.5F, 0.4999F, 0, 0});
       },
       1e-6},
      {"no weights",
       [](GltfBuilder& b) {
         set_weights(b, 0, {0, 0, 0, 0});
       }},
      {"joint twice",
       [](GltfBuilder& b) {
         set_weights(b, 0, {0.5F, 0, 0.5F, 0});
       }},
      {"joint that does not exist",
       [](GltfBuilder& b) { b.bin[b.document["bufferViews"][1]["byteOffset"].get<std::size_t>() + 3] = std::byte{9}; }},
      {"skeleton", [](GltfBuilder& b) { b.document["skins"][0]["skeleton"] = 0; }},
      {"no common root", [](GltfBuilder& b) { b.document["nodes"][1].erase("children"); }},
      {"joints outside the scene",
       [](GltfBuilder& b) {
         b.document["scenes"] = {{{"nodes", {0}}}};
       }},
      {"a node twice",
       [](GltfBuilder& b) {
         b.document["scenes"] = {{{"nodes", {0, 1, 1}}}};
       }},
      {"a child in the scene",
       [](GltfBuilder& b) {
         b.document["scenes"] = {{{"nodes", {0, 1, 2}}}};
       }},
      {"bounds",
       [](GltfBuilder& b) {
         accessor(b, 0)["max"] = {2, 1, 0};
       }},
      {"bounds slightly off",
       [](GltfBuilder& b) {
         accessor(b, 0)["max"] = {1.000001, 1, 0};
       }},
      {"no bounds", [](GltfBuilder& b) { accessor(b, 0).erase("min"); }},
      {"bounds of another length",
       [](GltfBuilder& b) {
         accessor(b, 0)["max"] = {1, 1};
       }},
      {"normalized float", [](GltfBuilder& b) { accessor(b, 0)["normalized"] = true; }},
      {"offset without a view",
       [](GltfBuilder& b) {
         b.document["accessors"].push_back(
             {{"byteOffset", 4}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
         attributes(b)["TEXCOORD_0"] = b.document["accessors"].size() - 1;
       }},
      {"attribute", [](GltfBuilder& b) { attributes(b)["COLOUR"] = 0; }},
      {"name", [](GltfBuilder& b) { b.document["nodes"][1]["name"] = 5; }},
      {"decimal", [](GltfBuilder& b) { b.document["nodes"][0]["mesh"] = 0.0; }},
      {"empty list", [](GltfBuilder& b) { b.document["nodes"][2]["children"] = json::array(); }},
      {"empty top list", [](GltfBuilder& b) { b.document["animations"] = json::array(); }},
      {"skin without a mesh", [](GltfBuilder& b) { b.document["nodes"][2]["skin"] = 0; }},
      {"target", [](GltfBuilder& b) { b.document["bufferViews"][0]["target"] = "vertices"; }},
      {"extension", [](GltfBuilder& b) { b.document["extensionsRequired"] = {"VRM"}; }},
      {"rotation",
       [](GltfBuilder& b) {
         b.document["nodes"][1]["rotation"] = {0, 0, 2, 2};
       },
       1e-6},
      {"rotation slightly off",
       [](GltfBuilder& b) {
         b.document["nodes"][1]["rotation"] = {0, 0, 0, 1.0009};
       },
       1e-6},
      {"animated rotation",
       [](GltfBuilder& b) {
         test::animate(b, 2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 2, 2});
       },
       1e-6},
      {"animated rotation slightly off",
       [](GltfBuilder& b) {
         test::animate(b, 2, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1.009F, 0, 0, 1, 0});
       },
       1e-6},
      {"channel without a node",
       [](GltfBuilder& b) {
         test::animate(b, 2, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
         b.document["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"path", "scale"}}}});
       }},
      {"animation that moves nothing",
       [](GltfBuilder& b) {
         test::animate(b, 2, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
         b.document["animations"][0]["channels"][0]["target"] = {{"path", "translation"}};
       }},
      {"shear",
       [](GltfBuilder& b) { b.document["nodes"][1]["matrix"] = {1, 0.5, 0, 0, 0, 1, 0, 0, 0.25, 0, 2, 0, 3, 4, 5, 1}; },
       2e-6},
      {"mirroring shear",
       [](GltfBuilder& b) { b.document["nodes"][1]["matrix"] = {1, 0.5, 0, 0, 0, -1, 0, 0, 0, 0.5, 2, 0, 3, 4, 5, 1}; },
       2e-6},
      {"flat matrix",
       [](GltfBuilder& b) { b.document["nodes"][1]["matrix"] = {1, 1, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0, 3, 4, 5, 1}; },
       2e-6},
      {"zero matrix",
       [](GltfBuilder& b) { b.document["nodes"][1]["matrix"] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 4, 5, 1}; }},
      {"last row of a matrix",
       [](GltfBuilder& b) { b.document["nodes"][1]["matrix"] = {1, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1}; }},
      {"normals",
       [](GltfBuilder& b) {
         add_normals(b, {0, 0, 5, 0, 0, 1, 0, 0, 1});
       }},
      {"normals without length",
       [](GltfBuilder& b) {
         add_normals(b, {0, 0, 0, 0, 0, 1, 0, 0, 1});
       }},
      {"normals that are not finite",
       [](GltfBuilder& b) {
         add_normals(b, {std::nanf(""), 0, 1, 0, 0, 1, 0, 0, 1});
       }},
      {"material",
       [](GltfBuilder& b) {
         b.document["materials"] = {
             {{"pbrMetallicRoughness", {{"baseColorFactor", {2, 1, 1, 1}}, {"metallicFactor", -1}}},
              {"alphaMode", 7},
              {"doubleSided", "yes"},
              {"name", 3}}};
         test::primitive(b)["material"] = 0;
       }},
      {"material that does not exist", [](GltfBuilder& b) { test::primitive(b)["material"] = 4; }},
      {"image",
       [](GltfBuilder& b) {
         b.add("SCALAR", std::vector<std::uint32_t>{1, 2, 3});
         b.document["images"] = {{{"bufferView", b.document["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
         b.document["textures"] = {{{"source", 0}}};
         b.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
         test::primitive(b)["material"] = 0;
       }},
      {"texture coordinates of another set",
       [](GltfBuilder& b) {
         attributes(b)["TEXCOORD_1"] = b.add("VEC2", std::vector<float>{std::nanf(""), 0, 0, 0, 0, 0});
         accessor(b, attributes(b)["TEXCOORD_1"]).erase("min");
         accessor(b, attributes(b)["TEXCOORD_1"]).erase("max");
       }},
      {"camera",
       [](GltfBuilder& b) {
         b.document["cameras"] = {{{"type", "fish eye"}}};
       }},
      {"morph targets",
       [](GltfBuilder& b) {
         test::primitive(b)["targets"] = {{{"POSITION", 0}, {"COLOUR", 0}}};
       }},
      {"unknown property", [](GltfBuilder& b) { b.document["nodes"][0]["colour"] = "green"; }},
      {"points beside",
       [](GltfBuilder& b) {
         b.document["meshes"][0]["primitives"].push_back({{"attributes", {{"JOINTS_0", 1}}}, {"mode", 0}});
       }},
      {"corners left over",
       [](GltfBuilder& b) {
         test::primitive(b)["indices"] = b.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 0});
       }},
      {"mirroring rigid node",
       [](GltfBuilder& b) {
         b.document["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
         b.document["nodes"].push_back({{"mesh", 1}, {"scale", {-1, 1, 1}}, {"translation", {2, 0, 0}}});
       }},
  };
  return all;
}

class CleanAvatar : public ::testing::TestWithParam<Variant> {};

TEST_P(CleanAvatar, HasNoErrorsAndTheSameSkin) {
  VESTIGE_REQUIRE_DATA(test::npm_package("gltf-validator"));
  GltfBuilder builder = test::skinned_triangle();
  GetParam().change(builder);
  EXPECT_LE(clean_difference_m(builder.glb()), GetParam().tolerance_m);
}

INSTANTIATE_TEST_SUITE_P(Variants, CleanAvatar, ::testing::ValuesIn(variants()), [](const auto& case_of) {
  std::string name = case_of.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

TEST(CleanAvatars, HaveNoErrorsAndTheSameSkinForAllThatIsAcceptedOfTheRealData) {
  VESTIGE_REQUIRE_DATA(test::npm_package("gltf-validator"));
  VESTIGE_REQUIRE_DATA(test::data("avatars"));
  std::size_t accepted = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::data("avatars"))) {
    if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
    SCOPED_TRACE(entry.path());
    std::vector<std::byte> glb;
    try {
      glb = read_avatar_glb(entry.path());
      static_cast<void>(parse_avatar_glb(glb, "a.glb"));
    } catch (const Error&) {
      continue;
    }
    ++accepted;
    EXPECT_EQ(clean_difference_m(glb), 0);
  }
  EXPECT_GT(accepted, 20U);
}

TEST(CleanAvatars, KeepColoursTexturesNormalsAndVrmRoles) {
  const auto json_of = [](const std::vector<std::byte>& glb) {
    const auto* text = reinterpret_cast<const char*>(glb.data());
    std::uint32_t length = 0;
    std::memcpy(&length, text + 12, sizeof length);
    return json::parse(std::string(text + 20, length));
  };
  GltfBuilder builder = test::skinned_triangle();
  add_normals(builder, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  builder.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}}};
  test::primitive(builder)["material"] = 0;
  const json bones = {{"hips", {{"node", 1}}}};
  builder.document["extensionsUsed"] = {"VRMC_vrm"};
  builder.document["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = bones;
  builder.document["asset"]["copyright"] = "A. Person";
  const json clean = json_of(clean_avatar_glb(builder.glb(), "a.glb"));
  EXPECT_TRUE(clean["meshes"][0]["primitives"][0]["attributes"].contains("NORMAL"));
  EXPECT_EQ(clean["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], json({0.5, 0.25, 1.0, 1.0}));
  EXPECT_EQ(clean["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"], bones);
  EXPECT_EQ(clean["asset"]["copyright"], "A. Person");

  const auto path = test::data("avatars/avatars/CesiumMan.glb");
  VESTIGE_REQUIRE_DATA(path);
  EXPECT_EQ(json_of(clean_avatar_glb(read_avatar_glb(path), "a.glb"))["images"].size(), 1U);
}

}  // namespace
}  // namespace vestige
