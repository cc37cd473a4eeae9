// Contraction to fma would change the bits of skinned vertices, and with them every contact: the compiler's flags must
// forbid it, and this is where it would be noticed if they did not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "detector/skinning.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "traces/base/sha256.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

/// detector/skinning.cpp, compiled with contraction allowed (tests/detector/CMakeLists.txt).
glm::vec3 skin_vertex_contracted(const Avatar& avatar, std::span<const SkinMatrix> palette, std::size_t vertex);

namespace {

TEST(Contraction, IsForbiddenWhereVerticesAreSkinned) {
  const Avatar& avatar = test::builtin_avatar();
  std::vector<glm::dmat4> world;
  std::vector<SkinMatrix> palette;
  const Pose pose = sample_animation(avatar, avatar.animations.front(), 0.7);
  world_matrices(avatar, pose, world);
  build_palette(avatar, world, glm::dvec3(0), palette);
  std::vector<glm::vec3> ours;
  skin_vertices(avatar, palette, ours);
  EXPECT_EQ(sha256_hex(std::as_bytes(std::span(ours))),
            "5618330b9085f6dc1c318e3b2d92a75a990770b8e00bf1bc8c743345b96b884d");
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor has no fma to compare with";
  std::vector<glm::vec3> contracted;
  contracted.reserve(ours.size());
  for (std::size_t i = 0; i < ours.size(); ++i) contracted.push_back(skin_vertex_contracted(avatar, palette, i));
  EXPECT_FALSE(std::ranges::equal(ours, contracted)) << "the hash above would not notice contraction";
#endif
}

}  // namespace
}  // namespace vestige
