#include "analysis/plot/studio/contact_density.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace vestige::plot {
namespace {

/// Two triangles, 1 m wide and high, that face +z.
Surface square() {
  Surface surface;
  surface.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  surface.corner_normals.assign(2, {glm::vec3(0, 0, 1), glm::vec3(0, 0, 1), glm::vec3(0, 0, 1)});
  return surface;
}

RecordedContact contact(std::uint32_t triangle, double u, double v) {
  RecordedContact result;
  result.triangle = triangle;
  result.barycentric = {u, v};
  return result;
}

/// How many contacts the density amounts to over all of a square's triangles.
double total(const ContactDensity& density, std::uint32_t triangles) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (std::uint32_t triangle = 0; triangle < triangles; ++triangle)
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j) {
        sum += density.at(triangle, (i + 1.0 / 3) / kSteps, (j + 1.0 / 3) / kSteps);
        if (i + j + 1 < kSteps) sum += density.at(triangle, (i + 2.0 / 3) / kSteps, (j + 2.0 / 3) / kSteps);
      }
  return sum / (2.0 * kSteps * kSteps);
}

constexpr double kSigma = 0.05;

TEST(ContactDensity, IsAGaussianAroundAContact) {
  const std::vector<RecordedContact> contacts = {contact(0, 0, 0.5)};  // the square's middle
  const ContactDensity density(square(), contacts, kSigma);
  const double peak = 1 / (2 * std::numbers::pi * kSigma * kSigma);
  EXPECT_NEAR(density.at(0, 0, 0.5), peak, 0.06 * peak);
  EXPECT_NEAR(density.at(1, 0.5, 0), peak, 0.06 * peak);
  EXPECT_NEAR(density.at(0, kSigma, 0.5), peak * std::exp(-0.5), 0.06 * peak);
  EXPECT_EQ(density.at(0, 0, 0), 0);
  EXPECT_NEAR(density.highest(), peak, 0.06 * peak);
}

TEST(ContactDensity, EveryContactCountsOneAlsoAtAHem) {
  const std::vector<RecordedContact> contacts = {contact(0, 0, 0.5), contact(0, 1, 0), contact(1, 0.3, 0.7)};
  EXPECT_NEAR(total(ContactDensity(square(), contacts, kSigma), 2), 3, 0.03);
}

TEST(ContactDensity, DoesNotReachThroughAThinSheetToItsOtherSide) {
  Surface sheet = square();
  for (const glm::vec3& position : square().position) sheet.position.push_back(position - glm::vec3(0, 0, 0.01F));
  sheet.triangles.push_back({4, 6, 5});
  sheet.triangles.push_back({4, 7, 6});
  sheet.corner_normals.resize(4, {glm::vec3(0, 0, -1), glm::vec3(0, 0, -1), glm::vec3(0, 0, -1)});
  const std::vector<RecordedContact> contacts = {contact(0, 0, 0.5)};
  const ContactDensity density(sheet, contacts, kSigma);
  EXPECT_NEAR(total(density, 2), 1, 0.01);
  EXPECT_EQ(density.at(2, 0.5, 0), 0);
}

TEST(ContactDensity, SurvivesTrianglesWithoutArea) {
  Surface surface = square();
  surface.triangles[1] = {0, 0, 0};
  surface.corner_normals[1] = {};
  const std::vector<RecordedContact> contacts = {contact(1, 0.5, 0.5)};
  const ContactDensity density(surface, contacts, kSigma);
  EXPECT_EQ(density.at(1, 0.5, 0.5), 0);
}

}  // namespace
}  // namespace vestige::plot
