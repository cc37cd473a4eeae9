// What is said of a driver's arithmetic, and when `geometry` is refused: answers as other drivers might give them.

#include "detector/shader_arithmetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <vector>

namespace vestige {
namespace {

using ::testing::HasSubstr;

/// The processor's own answers, in its current rounding mode.
std::vector<float> answers() {
  std::vector<float> found;
  for (const ProbeQuestion& question : probe_questions()) {
    // The compiler must not compute them itself.
    const volatile float a = question.a;
    const volatile float b = question.b;
    const float product = a * b;
    switch (question.operation) {
      case ProbeOperation::kAdd:
        found.push_back(a + b);
        break;
      case ProbeOperation::kSubtract:
        found.push_back(a - b);
        break;
      case ProbeOperation::kMultiply:
        found.push_back(product);
        break;
      case ProbeOperation::kDivide:
        found.push_back(a / b);
        break;
      case ProbeOperation::kMultiplyAdd:
        found.push_back(product + question.c);
        break;
    }
  }
  return found;
}

std::vector<float> answers_rounded(int mode) {
  const int before = std::fegetround();
  std::fesetround(mode);
  std::vector<float> found = answers();
  std::fesetround(before);
  return found;
}

TEST(ShaderArithmetic, LikeTheProcessorsBreaksNoProof) {
  const StageArithmetic stage = judge("vertex", answers());
  EXPECT_EQ(stage.stage, "vertex");
  EXPECT_EQ(stage.rounding, "nearest even");
  EXPECT_TRUE(stage.keeps_denormal_operands);
  EXPECT_TRUE(stage.keeps_denormal_results);
  EXPECT_FALSE(stage.contracts);
  EXPECT_GT(stage.division_error_ulp, 0.1);
  EXPECT_LE(stage.division_error_ulp, 0.5);
  EXPECT_EQ(breaks_proofs(std::vector{stage}, ""), "");
}

TEST(ShaderArithmetic, ThatRoundsOtherwiseBreaksTheProofsAndIsNamed) {
  const StageArithmetic good = judge("vertex", answers());
  const std::pair<int, const char*> modes[] = {
      {FE_TOWARDZERO, "toward zero"}, {FE_UPWARD, "up"}, {FE_DOWNWARD, "down"}};
  for (const auto& [mode, name] : modes) {
    const StageArithmetic bad = judge("geometry", answers_rounded(mode));
    EXPECT_EQ(bad.rounding, name);
    EXPECT_THAT(breaks_proofs(std::vector{good, bad}, ""),
                HasSubstr(std::string("geometry shaders do not round to nearest (") + name));
  }
}

TEST(ShaderArithmetic, WithAnySingleSumOrProductMisroundedBreaksTheProofs) {
  const std::span<const ProbeQuestion> questions = probe_questions();
  const StageArithmetic good = judge("vertex", answers());
  std::size_t broken = 0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    std::vector<float> off = answers();
    off[i] = std::nextafter(off[i], 1000.0F);
    const StageArithmetic stage = judge("vertex", off);
    EXPECT_NE(stage, good) << i;  // every answer counts for something
    if (!breaks_proofs(std::vector{stage}, "").empty()) ++broken;
  }
  EXPECT_EQ(broken, 17U);  // the others ask for denormals, contraction and division
}

TEST(ShaderArithmetic, ThatFlushesContractsAndDividesBadlyIsReportedAndBreaksNoProof) {
  std::vector<float> poor = answers();
  const std::span<const ProbeQuestion> questions = probe_questions();
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const ProbeQuestion& question = questions[i];
    const auto flushed = [](float x) { return std::fpclassify(x) == FP_SUBNORMAL ? 0.0F : x; };
    if (question.operation == ProbeOperation::kMultiply) poor[i] = flushed(flushed(question.a) * flushed(question.b));
    if (question.operation == ProbeOperation::kAdd) poor[i] = flushed(flushed(question.a) + flushed(question.b));
    if (question.operation == ProbeOperation::kSubtract) poor[i] = flushed(question.a - question.b);
    if (question.operation == ProbeOperation::kMultiplyAdd) poor[i] = std::fma(question.a, question.b, question.c);
    if (question.operation == ProbeOperation::kDivide)
      poor[i] = std::nextafter(std::nextafter(poor[i], 1000.0F), 1000.0F);
  }
  const StageArithmetic stage = judge("vertex", poor);
  EXPECT_FALSE(stage.keeps_denormal_operands);
  EXPECT_FALSE(stage.keeps_denormal_results);
  EXPECT_TRUE(stage.contracts);
  EXPECT_GT(stage.division_error_ulp, 1.5);
  EXPECT_LE(stage.division_error_ulp, 2.5);
  EXPECT_EQ(breaks_proofs(std::vector{stage}, ""), "");
}

TEST(ShaderArithmetic, ThatIsNotMeasuredBreaksTheProofs) {
  EXPECT_THAT(breaks_proofs({}, "unknown word 'precise'"),
              ::testing::AllOf(HasSubstr("not measured"), HasSubstr("unknown word 'precise'")));
}

}  // namespace
}  // namespace vestige
