// The built-in avatar, judged by the Khronos glTF validator: npm's gltf-validator, fetched into tests/npm/node_modules
// when it is not there yet.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/npm.hpp"
#include "tests/support/test_data.hpp"
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

}  // namespace
}  // namespace vestige
