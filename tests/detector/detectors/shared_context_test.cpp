// Detectors of several people in one OpenGL context.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/pairs/same_contact.hpp"
#include "tests/support/scene_run.hpp"
#include "traces/scene/subdivision.hpp"

namespace vestige {
namespace {

constexpr std::uint32_t kCollidersOfEach = 20;

enum class ContextSharer { kPaper, kGeometry, kSkippingGeometry, kCompute, kCullingCompute };

std::unique_ptr<Detector> make_sharer(ContextSharer kind, std::shared_ptr<GlContext> context, const Avatar& avatar) {
  if (kind == ContextSharer::kPaper)
    return make_paper_detector(std::move(context), avatar, test::builtin_map(), {.planes = kHashedPlanes});
  if (kind == ContextSharer::kCompute || kind == ContextSharer::kCullingCompute)
    return make_compute_detector(std::move(context), avatar, test::builtin_map(),
                                 {.planes = kHashedPlanes,
                                  .skip = Skip::kOn,
                                  .culling = kind == ContextSharer::kCompute ? Culling::kCpu : Culling::kGpu});
  return make_geometry_detector(
      std::move(context), avatar, test::builtin_map(),
      {.planes = kHashedPlanes, .skip = kind == ContextSharer::kGeometry ? Skip::kOff : Skip::kOn});
}

/// A detector in the shared context, and the same in a context of its own.
struct SharedAndOwn {
  std::unique_ptr<Detector> shared;
  std::unique_ptr<Detector> own;
  FrameBuilder builder;
  const std::vector<TraceFrame>& frames;
};

TEST(SharedContext, ChangesNoBitForDetectorsThatTakeTurns) {
  const Avatar& avatar = test::builtin_avatar();
  const Avatar finer = subdivided(avatar);
  const std::vector<TraceFrame> hug = test::scene("hug", avatar, kCollidersOfEach, 12, 15);
  const std::vector<TraceFrame> rain = test::scene("rain", finer, kCollidersOfEach, 12, 15);
  const std::shared_ptr<GlContext> context = test::make_context();
  std::vector<SharedAndOwn> pairs;
  for (const ContextSharer kind : {ContextSharer::kGeometry, ContextSharer::kPaper, ContextSharer::kSkippingGeometry,
                                   ContextSharer::kCompute, ContextSharer::kCullingCompute})
    for (const bool is_finer : {false, true}) {
      const Avatar& skin = is_finer ? finer : avatar;
      pairs.push_back({make_sharer(kind, context, skin), make_sharer(kind, test::make_context(), skin),
                       test::frame_builder(skin, kCollidersOfEach, Method::kStatic), is_finer ? rain : hug});
    }
  ContactRow row;
  ContactRow expected;
  std::size_t contacts = 0;
  for (std::size_t k = 0; k < hug.size(); ++k) {
    for (SharedAndOwn& pair : pairs) {
      const DetectorFrame& frame = pair.builder.next(pair.frames[k]);
      pair.shared->detect(frame, row);
      pair.own->detect(frame, expected);
      ASSERT_EQ(row.size(), expected.size());
      for (std::size_t i = 0; i < row.size(); ++i) {
        contacts += expected[i].hit() ? 1U : 0U;
        EXPECT_TRUE(test::same(row[i], expected[i])) << pair.shared->name() << ", frame " << k << ", column " << i;
      }
      std::vector<glm::vec3> skinned;
      std::vector<glm::vec3> skinned_alone;
      pair.shared->skinned_vertices(frame, skinned);
      pair.own->skinned_vertices(frame, skinned_alone);
      EXPECT_EQ(skinned, skinned_alone);
    }
  }
  EXPECT_GT(contacts, 50U);
}

}  // namespace
}  // namespace vestige
