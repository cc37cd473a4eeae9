#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/glb_container.hpp"
#include "traces/scene/reference_skinning.hpp"

// Whatever bytes a glTF file holds, loading it ends in an error that says something, or in an avatar that keeps what
// avatar.hpp promises and can be posed.

using vestige::fuzz::require;

namespace vestige {
namespace {

void check(const Avatar& avatar) {
  const std::size_t vertices = avatar.position_bind.size();
  require(!avatar.triangles.empty(), "there are triangles");
  require(avatar.texture_coordinate.size() == vertices && avatar.influences.size() == vertices, "one of each a vertex");
  require(avatar.node_order.size() == avatar.nodes.size(), "every node has its place");
  require(avatar.root_node >= 0 && static_cast<std::size_t>(avatar.root_node) < avatar.nodes.size(), "there is a root");
  for (const glm::uvec3& triangle : avatar.triangles)
    require(std::max({triangle.x, triangle.y, triangle.z}) < vertices, "triangles refer to vertices");
  for (const glm::vec3& position : avatar.position_bind)
    require(std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z),
            "positions are finite");
  for (const Influences& influences : avatar.influences) {
    double sum = 0;
    for (std::size_t i = 0; i < kMaxInfluences; ++i) {
      require(influences.palette[i] < avatar.palette.size(), "influences refer to the palette");
      require(influences.weight[i] >= 0, "no weight is negative");
      sum += double{influences.weight[i]};
    }
    require(std::abs(sum - 1) < 1e-5, "weights sum up to 1");
  }
  std::vector<glm::dvec3> positions;
  skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), positions);
  constexpr double kLargest = std::numeric_limits<float>::max();
  for (const glm::dvec3& position : positions)
    require(std::abs(position.x) <= kLargest && std::abs(position.y) <= kLargest && std::abs(position.z) <= kLargest,
            "the rest pose is finite");
  for (const Animation& animation : avatar.animations)
    for (const double part : {-1.0, 0.0, 0.3, 1.0, 2.0})
      sample_animation(avatar, animation, part * animation.duration_s);
  for (const Animation& animation : avatar.animations)
    require(!animation.morph || std::isfinite(animation.morph->reach_m), "morph targets go a finite way");
}

/// JSON, a zero and binary data are taken as the chunks of a GLB: so one byte more or less breaks no length.
std::vector<std::byte> joined(std::span<const std::byte> input) {
  const auto zero = std::find(input.begin(), input.end(), std::byte{0});
  if (zero == input.end() || input.front() != std::byte{'{'}) return {input.begin(), input.end()};
  const std::string_view json(reinterpret_cast<const char*>(input.data()),
                              static_cast<std::size_t>(zero - input.begin()));
  return gltf::join_glb(json, {zero + 1, input.end()}, gltf::Report("fuzz"));
}

}  // namespace
}  // namespace vestige

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  try {
    const std::vector<std::byte> glb = vestige::pack_avatar_glb(vestige::joined(input), "/nonexistent/fuzz.gltf");
    vestige::check(vestige::parse_avatar_glb(glb, "fuzz"));
  } catch (const vestige::Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  return 0;
}
