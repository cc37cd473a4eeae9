#include "detector/shader_arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vestige {

namespace {

constexpr float kUlp = 0x1p-23F;  // of 1

// Sums and products: ties to even both ways, and results close above and below the middle, of both signs. The denormal
// questions have exact results. A flushed operand or result changes them.
using enum ProbeOperation;
constexpr std::array<ProbeQuestion, 26> kQuestions = {{
    {1, kUlp / 2, 0, kAdd},
    {1, 0.75F * kUlp, 0, kAdd},
    {1, 0.25F * kUlp, 0, kAdd},
    {1 + kUlp, kUlp / 2, 0, kAdd},
    {-1, -kUlp / 2, 0, kAdd},
    {-1, -0.75F * kUlp, 0, kAdd},
    {-1, -0.25F * kUlp, 0, kAdd},
    {1, kUlp / 8, 0, kSubtract},
    {1, 0.375F * kUlp, 0, kSubtract},
    {-1, kUlp / 8, 0, kSubtract},
    {-1, 0.75F * kUlp, 0, kSubtract},
    {1 + kUlp, 1 + kUlp, 0, kMultiply},
    {1 - kUlp, 1 - kUlp, 0, kMultiply},
    {1 + 0x1p-12F, 1 + 0x1p-12F, 0, kMultiply},
    {-1 - kUlp, 1 + kUlp, 0, kMultiply},
    {1.1F, -1.3F, 0, kMultiply},
    {1.7F, 3.3F, 0, kMultiply},
    // A denormal operand, a normal result.
    {0x1p-130F, 0x1p20F, 0, kMultiply},
    {0x1p-126F, 0x1p-130F, 0, kAdd},
    // Normal operands, a denormal result.
    {0x1p-70F, 0x1p-70F, 0, kMultiply},
    {0x1.8p-126F, 0x1p-126F, 0, kSubtract},
    // a * b is a tie: rounded first, the sum is 0.
    {1 + 0x1p-12F, 1 + 0x1p-12F, -(1 + 0x1p-11F), kMultiplyAdd},
    {1, 3, 0, kDivide},
    {1, 0.7F, 0, kDivide},
    {1, 1 + kUlp, 0, kDivide},
    {-10, 1.9F, 0, kDivide},
}};
constexpr std::size_t kRoundingQuestions = 17;
constexpr std::size_t kDenormalOperands = 17;  // two questions, and two for results
constexpr std::size_t kDenormalResults = 19;
constexpr std::size_t kContraction = 21;
constexpr std::size_t kDivisions = 22;

/// Exact in double, except for divisions.
double exact(const ProbeQuestion& question) {
  const double a = static_cast<double>(question.a);
  const double b = static_cast<double>(question.b);
  switch (question.operation) {
    case kAdd:
      return a + b;
    case kSubtract:
      return a - b;
    case kMultiply:
      return a * b;
    case kDivide:
      return a / b;
    case kMultiplyAdd:
      return a * b + static_cast<double>(question.c);
  }
  return 0;
}

constexpr const char* kNearest = "nearest even";

/// The modes, each with its rounding of a double.
struct Mode {
  const char* name;
  float (*round)(double);
};
float to_nearest(double x) {
  return static_cast<float>(x);
}
float up(double x) {
  const float nearest = to_nearest(x);
  return static_cast<double>(nearest) < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}
float down(double x) {
  return -up(-x);
}
float toward_zero(double x) {
  return x < 0 ? up(x) : down(x);
}
constexpr std::array<Mode, 4> kModes = {
    {{kNearest, to_nearest}, {"toward zero", toward_zero}, {"up", up}, {"down", down}}};

bool fits(std::span<const float> answers, std::size_t i, float (*round)(double)) {
  return answers[i] == round(exact(kQuestions[i]));
}

std::string rounding_of(std::span<const float> answers) {
  for (const Mode& mode : kModes) {
    bool all = true;
    for (std::size_t i = 0; i < kRoundingQuestions; ++i) all = all && fits(answers, i, mode.round);
    if (all) return mode.name;
  }
  return "other";
}

std::string first_misrounded(std::span<const float> answers) {
  for (std::size_t i = 0; i < kRoundingQuestions; ++i) {
    if (fits(answers, i, to_nearest)) continue;
    const ProbeQuestion& question = kQuestions[i];
    const char* sign = question.operation == kAdd ? "+" : question.operation == kSubtract ? "-" : "*";
    return fmt::format("{} {} {} is {}, not {}", question.a, sign, question.b, answers[i], to_nearest(exact(question)));
  }
  return "";
}

double division_error_ulp(std::span<const float> answers) {
  double largest = 0;
  for (std::size_t i = kDivisions; i < kQuestions.size(); ++i) {
    const double quotient = exact(kQuestions[i]);
    const double ulp = std::ldexp(1.0, std::ilogb(quotient) - 23);
    largest = std::max(largest, std::abs(static_cast<double>(answers[i]) - quotient) / ulp);
  }
  return largest;
}

}  // namespace

std::span<const ProbeQuestion> probe_questions() {
  return kQuestions;
}

StageArithmetic judge(std::string_view stage, std::span<const float> answers) {
  const auto both_exact = [&](std::size_t i) {
    return fits(answers, i, to_nearest) && fits(answers, i + 1, to_nearest);
  };
  return {.stage = std::string(stage),
          .rounding = rounding_of(answers),
          .misrounded = first_misrounded(answers),
          .keeps_denormal_operands = both_exact(kDenormalOperands),
          .keeps_denormal_results = both_exact(kDenormalResults),
          .contracts = answers[kContraction] != 0,
          .division_error_ulp = division_error_ulp(answers)};
}

std::string breaks_proofs(std::span<const StageArithmetic> stages, std::string_view refusal) {
  if (stages.empty())
    return fmt::format("the arithmetic of the driver's shaders is not measured, because it refuses the probe: {}",
                       refusal);
  for (const StageArithmetic& stage : stages)
    if (!stage.misrounded.empty())
      return fmt::format("the driver's {} shaders do not round to nearest ({}): {}", stage.stage, stage.rounding,
                         stage.misrounded);
  return "";
}

}  // namespace vestige
