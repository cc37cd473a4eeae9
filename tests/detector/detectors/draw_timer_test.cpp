// A driver's timer, where it can be believed and where it cannot.

#include "detector/gl/draw_timer.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "detector/gl/gl_context.hpp"
#include "tests/support/gl/gl_context.hpp"

namespace vestige {
namespace {

const GLubyte* APIENTRY hardware_name(GLenum /*name*/) {
  return reinterpret_cast<const GLubyte*>("Fast GPU");
}
const GLubyte* APIENTRY software_name(GLenum /*name*/) {
  return reinterpret_cast<const GLubyte*>("llvmpipe (LLVM 15.0.6, 256 bits)");
}
void APIENTRY half_a_millisecond(GLuint /*query*/, GLenum /*name*/, GLuint64* ns) {
  *ns = 500'000;
}
void APIENTRY an_hour(GLuint /*query*/, GLenum /*name*/, GLuint64* ns) {
  *ns = 3'600'000'000'000;
}
void APIENTRY no_counter(GLenum /*target*/, GLenum /*name*/, GLint* bits) {
  *bits = 0;
}
void APIENTRY all_bits(GLenum /*target*/, GLenum /*name*/, GLint* bits) {
  *bits = 64;
}

class DrawTime : public ::testing::Test {
 protected:
  DrawTime() : context_(test::make_context()), functions_(current_gl(*context_)) {
    functions_.GetString = hardware_name;
    functions_.GetQueryiv = all_bits;
    functions_.GetQueryObjectui64v = half_a_millisecond;
  }

  /// Two draws of 1 ms each.
  void draw(StageClock& clock) const {
    DrawTimer timer(functions_);
    for (int i = 0; i < 2; ++i)
      timer.time(&clock, [] {
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1);
        while (std::chrono::steady_clock::now() < end) {
        }
      });
  }

  void expect_by_clock() const {
    StageClock clock;
    draw(clock);
    EXPECT_EQ(clock.drawn_by(), DrawnBy::kClock);
    ASSERT_EQ(clock.times().size(), 1U);
    EXPECT_EQ(clock.times()[0].stage, Stage::kDraw);
    EXPECT_GT(clock.times()[0].us, 1900);
  }

  std::unique_ptr<GlContext> context_;
  GlFunctions functions_;
};

TEST_F(DrawTime, IsTheHardwaresOwnAndTheRestIsWaiting) {
  StageClock clock;
  draw(clock);
  EXPECT_EQ(clock.drawn_by(), DrawnBy::kTimer);
  ASSERT_EQ(clock.times().size(), 2U);
  EXPECT_EQ(clock.times()[0].stage, Stage::kDraw);
  EXPECT_DOUBLE_EQ(clock.times()[0].us, 1000);
  EXPECT_EQ(clock.times()[1].stage, Stage::kWait);
  EXPECT_GT(clock.times()[1].us, 900);
}

TEST_F(DrawTime, IsTheClocksIfTheDriverSaysMoreThanCanBe) {
  functions_.GetQueryObjectui64v = an_hour;
  expect_by_clock();
}

TEST_F(DrawTime, IsTheClocksIfTheDriverHasNoCounter) {
  functions_.GetQueryiv = no_counter;
  expect_by_clock();
}

TEST_F(DrawTime, IsTheClocksWithASoftwareRendererWhateverItSays) {
  functions_.GetString = software_name;
  expect_by_clock();
}

TEST_F(DrawTime, IsNotAskedForWithoutAClock) {
  DrawTimer timer(functions_);
  bool drawn = false;
  timer.time(nullptr, [&] { drawn = true; });
  EXPECT_TRUE(drawn);
}

}  // namespace
}  // namespace vestige
