#include <algorithm>
#include <chrono>
#include <cmath>

#include "tests/fuzz/require.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/live/live_state.hpp"
#include "traces/scene/builtin_avatar.hpp"

// Whatever comes over the network, whole frames are such that can be recorded and felt: finite, each collider once. The
// input is several datagrams: two bytes of length, then so many bytes. The length's parity also tells two senders
// apart.

using vestige::fuzz::require;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  static const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  LiveState state(avatar, glm::dvec3(0), {}, LiveState::Senders::kOneAtATime);
  std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  std::uint64_t datagrams = 0;
  while (input.size() >= 2) {
    const std::size_t said = 256 * std::to_integer<std::size_t>(input[0]) + std::to_integer<std::size_t>(input[1]);
    const std::size_t length = std::min(said, input.size() - 2);
    Datagram datagram = {.bytes = input.subspan(2, length)};
    datagram.arrived += std::chrono::milliseconds(30 * datagrams);
    datagram.sender.bytes.front() = static_cast<std::byte>(said % 2);
    state.take(datagram);
    input = input.subspan(2 + length);
    ++datagrams;
  }
  TraceFrame frame;
  state.show(frame);
  require(state.vmc().malformed() + state.left_out() <= datagrams, "a datagram is left out once");
  require(state.frames() <= 2 * datagrams, "a datagram ends a frame, and is one");
  require(frame.poses.front().nodes.size() == avatar.nodes.size(), "a pose fits the avatar");
  for (const NodeLocal& node : frame.poses.front().nodes)
    require(std::isfinite(glm::dot(node.rotation, node.rotation)), "rotations are finite");
  for (std::size_t i = 1; i < frame.colliders.size(); ++i)
    require(frame.colliders[i - 1].id < frame.colliders[i].id, "each collider is there once");
  return 0;
}
