#include <cmath>
#include <cstring>

#include "detector/output/recorded_contacts.hpp"
#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"
#include "traces/exchange/collider_files.hpp"
#include "traces/exchange/collider_rows.hpp"
#include "traces/exchange/pose_csv.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/colliders.hpp"

// Whatever a CSV file holds, reading it as colliders, contacts or poses ends in an error that says something, or in
// frames that can be recorded: finite, one behind the other.

using namespace vestige;  // NOLINT(google-build-using-namespace)
using vestige::fuzz::require;

namespace {

template <typename Read>
void try_to(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
}

void read_colliders(const std::filesystem::path& path) {
  const auto colliders = read_collider_csv(path);
  const TimeSpan span = colliders->span_s();
  require(span.first_s <= span.last_s, "time does not run back");
  std::vector<ColliderSample> samples;
  for (const double part : {0.0, 0.4, 1.0})
    colliders->sample(span.first_s + part * (span.last_s - span.first_s), samples);
}

void read_poses(const std::filesystem::path& path) {
  static const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  PoseCsvReader poses(path, avatar);
  TraceFrame frame;
  for (std::uint64_t next_index = 0; poses.next(frame); next_index = frame.index + 1) {
    require(frame.index >= next_index, "frames do not run back");
    require(frame.poses.front().nodes.size() == avatar.nodes.size(), "a pose fits the avatar");
    for (const NodeLocal& node : frame.poses.front().nodes)
      require(std::isfinite(glm::dot(node.rotation, node.rotation)), "rotations are finite");
  }
}

void read_collider_frames(const std::filesystem::path& path) {
  ColliderRows rows(path);
  ColliderRow row;
  for (std::uint64_t last = 0; rows.next(row); last = row.frame) require(row.frame >= last, "frames do not run back");
  ColliderFrames frames(path);
  TraceFrame frame;
  frames.fill(frame);
  for (const ColliderSample& sample : frame.colliders)
    require(std::isfinite(sample.position_m.x), "positions are finite");
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = fuzz::in_a_file({reinterpret_cast<const std::byte*>(data), size});
  try_to([&] { read_colliders(path); });
  try_to([&] { read_contacts(path); });
  try_to([&] { read_poses(path); });
  try_to([&] { read_collider_frames(path); });
  return 0;
}
