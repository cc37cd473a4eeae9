#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

Avatar load(const std::filesystem::path& path) {
  return parse_avatar_glb(read_avatar_glb(path), path.filename().string());
}

struct Expected {
  const char* file;
  std::size_t vertices;
  std::size_t triangles;
  std::size_t joints;
  std::size_t animations;
  std::size_t influences;
};

std::ostream& operator<<(std::ostream& out, const Expected& expected) {
  return out << expected.file;
}

class RealAvatar : public ::testing::TestWithParam<Expected> {};

TEST_P(RealAvatar, LoadsWithItsCounts) {
  const std::filesystem::path path = test::data("avatars") / GetParam().file;
  VESTIGE_REQUIRE_DATA(path);
  const Avatar avatar = load(path);
  EXPECT_EQ(avatar.position_bind.size(), GetParam().vertices);
  EXPECT_EQ(avatar.texture_coordinate.size(), GetParam().vertices);
  EXPECT_EQ(avatar.influences.size(), GetParam().vertices);
  EXPECT_EQ(avatar.triangles.size(), GetParam().triangles);
  EXPECT_EQ(avatar.joint_count, GetParam().joints);
  EXPECT_EQ(avatar.animations.size(), GetParam().animations);
  EXPECT_EQ(avatar.influence_count, GetParam().influences);
  EXPECT_EQ(avatar.node_order.size(), avatar.nodes.size());
  for (const Influences& influences : avatar.influences) {
    double sum = 0;
    for (std::size_t i = 0; i < kMaxInfluences; ++i) {
      sum += double{influences.weight[i]};
      EXPECT_LT(influences.palette[i], avatar.palette.size());
      if (i > 0 && influences.weight[i] > 0) {
        EXPECT_LT(influences.palette[i - 1], influences.palette[i]);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

// The Knight's skinned meshes alone are 3716 vertices and 4148 triangles; shields, weapons, helmet and cape are rigid.
INSTANTIATE_TEST_SUITE_P(
    Files, RealAvatar,
    ::testing::Values(Expected{"avatars/CesiumMan.glb", 3273, 4672, 19, 1, 4},
                      Expected{"avatars/Fox.glb", 1728, 576, 24, 3, 4},
                      Expected{"avatars/KayKit_Knight.glb", 7024, 6952, 41, 76, 4},
                      Expected{"avatars/MakeHumanBase_cc0_8inf.glb", 14517, 26756, 163, 1, 8},
                      Expected{"avatars/greenman.glb", 196, 356, 12, 4, 4},
                      Expected{"avatars/RiggedFigure_3dsmax/RiggedFigure.gltf", 768, 256, 19, 1, 4},
                      Expected{"skin/RiggedSimple.gltf", 160, 188, 2, 1, 2},
                      Expected{"skin/SimpleSkin.gltf", 10, 8, 2, 1, 2},
                      Expected{"skin/interpolation_test.gltf", 220, 110, 0, 9, 1},
                      Expected{"skin/AssetGenerator/Animation_SkinType_00.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_SkinType_01.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_SkinType_02.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_SkinType_03.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_00.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_01.gltf", 6, 4, 2, 1, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_02.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_03.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_04.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/AssetGenerator/Animation_Skin_07.gltf", 6, 4, 2, 0, 1},
                      Expected{"skin/godot/duplicate_skinned_mesh_combined.glb", 3366, 6144, 6, 1, 2},
                      Expected{"skin/godot/modified_bone_animation_test.glb", 24, 18, 3, 1, 2}),
    [](const auto& case_of) {
      std::string name = case_of.param.file;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

TEST(RealAvatars, CesiumManWalksUprightAtHumanHeight) {
  const std::filesystem::path path = test::data("avatars/avatars/CesiumMan.glb");
  VESTIGE_REQUIRE_DATA(path);
  const Avatar avatar = load(path);
  ASSERT_EQ(avatar.animations.size(), 1U);
  EXPECT_EQ(avatar.animations[0].duration_s, 2.0);
  for (const double time_s : {0.0, 0.5, 1.0, 1.7, 2.0}) {
    std::vector<glm::dvec3> positions;
    skin_reference(avatar, sample_animation(avatar, avatar.animations[0], time_s), glm::dvec3(0), positions);
    glm::dvec3 least(std::numeric_limits<double>::infinity());
    glm::dvec3 most = -least;
    for (const glm::dvec3& position : positions) {
      least = glm::min(least, position);
      most = glm::max(most, position);
    }
    EXPECT_NEAR(most.y - least.y, 1.5, 0.1) << "height at " << time_s << " s";
    EXPECT_LT(most.x - least.x, 0.8) << "shoulders at " << time_s << " s";
    EXPECT_LT(most.z - least.z, 1.0) << "stride at " << time_s << " s";
    EXPECT_NEAR(least.y, 0, 0.1) << "feet at " << time_s << " s";
  }
}

TEST(RealAvatars, NodesAboveASkinnedMeshDoNotMoveIt) {
  const std::filesystem::path plain = test::data("avatars/skin/AssetGenerator/Animation_Skin_00.gltf");
  const std::filesystem::path moved = test::data("avatars/skin/AssetGenerator/Animation_Skin_02.gltf");
  VESTIGE_REQUIRE_DATA(moved);
  const auto positions = [](const Avatar& avatar) {
    std::vector<glm::dvec3> result;
    skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), result);
    return result;
  };
  EXPECT_EQ(positions(load(plain)), positions(load(moved)));
}

/// What a file that the Khronos validator judged must lead to here: an error that holds all these words, or, when the
/// list is empty, an avatar.
struct Judged {
  const char* file;
  std::vector<const char*> words;
};

// The validator's own examples have no triangles, except a few; where it has nothing to object, that is what is
// refused.
const std::vector<Judged> kJudged = {
    {"glb/bom.glb", {"byte order mark", "no triangles"}},
    {"glb/chunk_too_big.glb", {"byte 8", "no room for a chunk"}},
    {"glb/empty_file.glb", {"byte 0", "too few"}},
    {"glb/empty_json_chunk.glb", {"byte 12", "empty"}},
    {"glb/empty_json_object.glb", {"'asset' is missing"}},
    {"glb/extra_data.glb", {"byte 48", "no triangles"}},
    {"glb/invalid_json_chunk.glb", {"JSON cannot be read"}},
    {"glb/invalid_magic.glb", {"byte 0", "does not start with 'glTF'"}},
    {"glb/invalid_version.glb", {"byte 4", "version"}},
    {"glb/json_and_two_buffers.glb", {"byte 88", "BIN"}},
    {"glb/length_mismatch.glb", {"byte 8", "has only 48"}},
    {"glb/misplaced_bin_chunk.glb", {"byte 88", "BIN"}},
    {"glb/no_header.glb", {"byte 1", "too few"}},
    {"glb/only_bin_chunk.glb", {"byte 12", "not JSON"}},
    {"glb/only_header.glb", {"byte 8", "no room"}},
    {"glb/truncated_chunk_data.glb", {"byte 8", "has only 47"}},
    {"glb/truncated_chunk_header.glb", {"byte 8", "no room for a chunk"}},
    {"glb/two_bin_chunks.glb", {"byte 12", "not JSON"}},
    {"glb/two_empty_bin_chunks.glb", {"byte 12", "not JSON"}},
    {"glb/two_empty_json_chunks.glb", {"byte 12", "empty"}},
    {"glb/two_images.glb", {"no triangles"}},
    {"glb/two_valid_json_chunks.glb", {"byte 48", "second JSON"}},
    {"glb/unaligned_chunk.glb", {"no triangles", "byte 12", "multiple of 4"}},
    {"glb/unknown_chunk.glb", {"byte 12", "not JSON"}},
    {"glb/valid.glb", {"no triangles"}},
    {"glb/valid_buffer.glb", {"no triangles"}},
    {"glb/zero_chunk_header.glb", {"byte 12", "not JSON"}},
    {"glb/zero_length.glb", {"byte 8", "no room"}},
    {"skin/buffer_view_bytestride.gltf", {"byteStride", "skins[0].inverseBindMatrices"}},
    {"skin/custom_property.gltf", {"no triangles", "skins[0].customProperty"}},
    {"skin/empty_array.gltf", {"no triangles", "skins: is empty"}},
    {"skin/empty_joints_array.gltf", {"skins[0].joints: is empty"}},
    {"skin/empty_object.gltf", {"skins[0]", "'joints' is missing"}},
    {"skin/ibm_invalid_count.gltf", {"skins[2].inverseBindMatrices", "2 matrices for 3 joints"}},
    {"skin/ibm_invalid_format.gltf", {"is MAT3", "skins[0].inverseBindMatrices"}},
    {"skin/ignored_animated_transform.gltf", {"animations[0].samplers[0].input", "is not later"}},
    {"skin/ignored_local_transform.gltf", {}},
    {"skin/ignored_parent_transform.gltf", {}},
    {"skin/no_common_root.gltf", {"no triangles", "skins[0].joints: have no common root"}},
    {"skin/no_joints_in_scene.gltf", {}},
    {"skin/skeleton_invalid.gltf", {"no triangles", "skins[0].skeleton: is not above"}},
    {"skin/unresolved_ibm.gltf", {"skins[0].inverseBindMatrices: 0 does not exist"}},
    {"skin/unresolved_joint.gltf", {"skins[0].joints[0]: 0 does not exist"}},
    {"skin/unresolved_skeleton.gltf", {"skins[0].skeleton: 1 does not exist"}},
    {"skin/valid.gltf", {"skins[0].inverseBindMatrices: matrix 0 is not affine"}},
};

TEST(RealAvatars, MalformedFilesAreRefusedByName) {
  const std::filesystem::path folder = test::data("avatars/malformed/validator");
  VESTIGE_REQUIRE_DATA(folder);
  for (const Judged& judged : kJudged) {
    const std::filesystem::path path = folder / judged.file;
    std::string message;
    try {
      load(path);
    } catch (const Error& error) {
      message = error.what();
    }
    EXPECT_EQ(message.empty(), judged.words.empty()) << judged.file << ": " << message;
    for (const char* word : judged.words) EXPECT_THAT(message, HasSubstr(word)) << judged.file;
  }
}

TEST(RealAvatars, EveryMalformedFileIsKnown) {
  const std::filesystem::path folder = test::data("avatars/malformed/validator");
  VESTIGE_REQUIRE_DATA(folder);
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf") ++found;
  EXPECT_EQ(found, kJudged.size());
}

TEST(RealAvatars, NoJointsInSceneIsWarnedOf) {
  const std::filesystem::path path = test::data("avatars/malformed/validator/skin/no_joints_in_scene.gltf");
  VESTIGE_REQUIRE_DATA(path);
  EXPECT_THAT(load(path).warnings, ::testing::Contains(HasSubstr("nodes[2].skin: has joints outside the scene")));
}

}  // namespace
}  // namespace vestige
