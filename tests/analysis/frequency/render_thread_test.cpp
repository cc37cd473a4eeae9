#include "analysis/frequency/render_thread.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/scene_renderer.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/scene_run.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

const std::vector<TraceFrame>& orbit() {
  static const std::vector<TraceFrame> frames = test::scene("orbit", builtin_avatar(), 20, 20, 5, {1000, 0, -7});
  return frames;
}

std::vector<const TraceFrame*> shown() {
  std::vector<const TraceFrame*> frames;
  for (const TraceFrame& frame : orbit()) frames.push_back(&frame);
  return frames;
}

struct Kind {
  const char* name;
  RenderThread::MakeContext make_context;
};

class RenderedScene : public ::testing::TestWithParam<Kind> {};

INSTANTIATE_TEST_SUITE_P(Each, RenderedScene,
                         // own context: OSMesa, beside the one of all tests
                         ::testing::Values(Kind{"gl", test::make_context}, Kind{"osmesa", make_osmesa_context}),
                         [](const auto& test) { return std::string(test.param.name); });

struct Colours {
  std::size_t skin = 0;
  std::size_t collider = 0;
  std::size_t background = 0;
};

/// Skin is reddish and stands upright in the middle; colliders are blue.
Colours colours_of(const std::vector<std::uint8_t>& pixels) {
  Colours colours;
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const int red = pixels[i];
    const int blue = pixels[i + 2];
    if (red > blue + 15) ++colours.skin;
    if (blue > red + 100) ++colours.collider;
    if (std::abs(red - blue) < 8 && red > 200) ++colours.background;
  }
  return colours;
}

TEST_P(RenderedScene, ShowsTheBodyAndItsCollidersWhereverTheyAre) {
  SceneRenderer renderer(GetParam().make_context(), builtin_avatar());
  renderer.draw(orbit()[7]);
  const std::vector<std::uint8_t> pixels = renderer.pixels();
  const Colours colours = colours_of(pixels);
  const auto whole = static_cast<std::size_t>(SceneRenderer::kWidth * SceneRenderer::kHeight);
  EXPECT_GT(colours.skin, whole / 50);
  EXPECT_LT(colours.skin, whole / 3);
  EXPECT_GT(colours.collider, 100U);
  EXPECT_GT(colours.background, whole / 2);

  renderer.draw(orbit()[0]);
  EXPECT_NE(renderer.pixels(), pixels);
}

TEST_P(RenderedScene, IsDrawnBesideADetectorAndPausesWhenTold) {
  RenderThread thread(GetParam().make_context, builtin_avatar(), shown());
  EXPECT_FALSE(thread.gl_info().renderer.empty());
  const auto detector = make_paper_detector(GetParam().make_context(), builtin_avatar(), ActuatorMap(), {});
  const test::SceneRun alone = test::run_scene(orbit(), builtin_avatar(), 20, *detector);
  thread.resume();
  test::SceneRun beside;
  for (int i = 0; i < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    beside = test::run_scene(orbit(), builtin_avatar(), 20, *detector);
  }
  EXPECT_GT(thread.pause(), 0U);
  std::this_thread::sleep_for(std::chrono::milliseconds(40));
  EXPECT_EQ(beside.contacts(), alone.contacts());
  thread.resume();
  EXPECT_EQ(thread.pause(), 0U);  // the first frame is due half a period after `resume`
  EXPECT_EQ(thread.pause(), 0U);
}

TEST(RenderThread, EndsAtOnceWhetherRunningOrNot) {
  for (const bool running : {false, true}) {
    RenderThread thread(test::make_context, builtin_avatar(), shown());
    if (running) thread.resume();
  }
}

TEST(RenderThread, HandsOnWhatGoesWrongInIt) {
  const auto no_context = []() -> std::unique_ptr<GlContext> { throw Error("--context", "there is none", "make one"); };
  EXPECT_THROW(RenderThread(no_context, builtin_avatar(), shown()), Error);
}

}  // namespace
}  // namespace vestige
