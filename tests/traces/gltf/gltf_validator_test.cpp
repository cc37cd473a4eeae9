// The built-in avatar and an exported trace, judged by the Khronos glTF validator: npm's gltf-validator, fetched into
// tests/npm/node_modules when it is not there yet.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/npm.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

TEST(GltfValidator, FindsNoFaultInTheMannequin) {
  VESTIGE_REQUIRE_DATA(test::npm_package("gltf-validator"));
  const test::TemporaryFolder folder;
  const auto glb = builtin_avatar_glb();
  std::ofstream(folder / "mannequin.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  const nlohmann::json issues = nlohmann::json::parse(test::run_node("validate_gltf.mjs", folder / "mannequin.glb"));
  EXPECT_EQ(issues["numErrors"], 0) << issues.dump(2);
  EXPECT_EQ(issues["numWarnings"], 0) << issues.dump(2);
}

TEST(GltfValidator, FindsNoErrorInTheExportOfPeopleWhoseAvatarHasFaults) {
  VESTIGE_REQUIRE_DATA(test::npm_package("gltf-validator"));
  test::GltfBuilder builder = test::skinned_triangle();
  const std::vector<float> weights = {7, 5, 0, 0};
  std::memcpy(builder.bin.data() + builder.document["bufferViews"][2]["byteOffset"].get<std::size_t>(), weights.data(),
              weights.size() * sizeof(float));
  builder.document["skins"][0]["skeleton"] = 0;
  builder.document["nodes"][1]["matrix"] = {1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1};
  const std::vector<std::byte> glb = builder.glb();
  const Avatar avatar = parse_avatar_glb(glb, "a.glb");
  const test::TemporaryFolder folder;
  // Twice.
  const std::vector<GltfPerson> people = {{"ann", avatar, glb}, {"bob", avatar, glb}};
  const auto file = make_frame_gltf(folder / "a.glb", Overwrite::kRefuse, people, {.all = {7, 8}, .spheres = {8}});
  for (int i = 0; i < 3; ++i) {
    TraceFrame frame;
    frame.time_ns = i * 1'000'000;
    frame.poses.front() = rest_pose(avatar);
    frame.poses.front().origin_m.x = i;
    frame.poses.front().nodes[2].translation.y = static_cast<float>(i);
    frame.poses.push_back(frame.poses.front());
    frame.colliders = {{7, glm::dvec3(0.5 * i, 0, 0)}, {8, glm::dvec3(1, 0, 0), 0.1F * static_cast<float>(i + 1)}};
    file->write(frame);
  }
  file->commit();
  const nlohmann::json issues = nlohmann::json::parse(test::run_node("validate_gltf.mjs", folder / "a.glb"));
  EXPECT_EQ(issues["numErrors"], 0) << issues.dump(2);
}

}  // namespace
}  // namespace vestige
