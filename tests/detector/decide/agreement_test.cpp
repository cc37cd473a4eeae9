// The deciding code against the slow truth, on cases that are hard in every way we know. The program `agreement` asks
// the same of as many pairs as one likes.

#include "tests/support/pairs/agreement.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/pairs/contact_cases.hpp"

namespace vestige {
namespace {

class Agreement : public ::testing::TestWithParam<std::string_view> {};

TEST_P(Agreement, OfStaticDecisionsWithTheTruthIsComplete) {
  const test::Agreement agreement = test::compare_with_truth(Method::kStatic, GetParam(), 1, 20000);
  EXPECT_EQ(agreement.differences, 0U) << ::testing::PrintToString(agreement.examples);
  EXPECT_GT(agreement.contacts, 300U);
}

TEST_P(Agreement, OfContinuousDecisionsWithTheTruthIsComplete) {
  const std::uint64_t pairs = GetParam() == "extreme" ? 400 : 5000;  // exact arithmetic on those takes its time
  const test::Agreement agreement = test::compare_with_truth(Method::kCcd, GetParam(), 1, pairs);
  EXPECT_EQ(agreement.differences, 0U) << ::testing::PrintToString(agreement.examples);
  EXPECT_GT(agreement.contacts, pairs / 20);
}

TEST_P(Agreement, OfSpheresWithTheTruthIsComplete) {
  for (const Method method : {Method::kStatic, Method::kCcd}) {
    const std::uint64_t pairs = GetParam() == "extreme" ? 40 : (method == Method::kCcd ? 1000 : 4000);
    const test::Agreement agreement = test::compare_spheres_with_truth(method, GetParam(), 1, pairs);
    EXPECT_EQ(agreement.differences, 0U) << ::testing::PrintToString(agreement.examples);
    EXPECT_GT(agreement.contacts, pairs / 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Agreement, ::testing::ValuesIn(test::case_families()),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace vestige
