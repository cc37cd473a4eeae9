#include "detector/decide/triangle_distance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "detector/decide/bounded.hpp"
#include "detector/nearest_in_triangle.hpp"

namespace vestige {

namespace {

// Let u = kUnit and m = reach. Every coordinate of a computed corner errs by at most 4 u m.
//
// Above: the point q = w0 A + w1 B + w2 C is in the triangle, but for rounding, if the weights are not negative and sum
// to 1 within 4 u. The sum of the weights moves it by 4 u m at most. Three products and two sums err by 5 u m. The
// corners err by 4 u m in each coordinate, so by 7 u m in length. The computed length of q errs by 4 u m: 20 u m in
// all.
//
// Below: for every vector g, each point y of the triangle has y.g >= min(A.g, B.g, C.g), so |y| >= that / |g|. This is
// sharp if g is the nearest point (Rockafellar 1970, Convex Analysis, theorem 11.4: two convex sets are as far apart as
// two parallel planes between them). A product P.g errs by 4 u m |g| sqrt(3) from the corner, and by 3 u m |g| from its
// own three roundings; that the computed g / |g| has the length 1 up to 6 u adds 6 u m: less than 17 u m.
constexpr double kDistanceError = 32 * kUnit;
/// Below this square, the length of g may have lost bits to underflow, and the distance is at most 2^-450.
constexpr double kLeastSquare = 0x1p-900;

/// Returns the point of the triangle that is nearest to the origin, but for rounding, if the triangle has an area.
/// Otherwise some point of it.
glm::dvec3 near_origin(const Corners& corners) {
  const glm::dvec3 weights = nearest_in_triangle(glm::dvec3(0), corners);
  const double excess = (weights.x + weights.y + weights.z) - 1;
  return are_shares(weights) && std::abs(excess) <= 4 * kUnit ? weighed(weights, corners) : corners.a;
}

/// Returns the range that a point of the triangle proves, by itself and as a direction.
Separation proven_by(const glm::dvec3& point, const Corners& corners, double reach) {
  const double square = glm::dot(point, point);
  const double length = std::sqrt(square);
  const double error = kDistanceError * reach;
  if (square < kLeastSquare) return {{0, length + error}, glm::dvec3(0)};
  const glm::dvec3 direction = point / length;
  const double least =
      std::min({glm::dot(corners.a, direction), glm::dot(corners.b, direction), glm::dot(corners.c, direction)});
  return {{std::max(0.0, least - error), length + error}, direction};
}

}  // namespace

double reach_of(const Corners& corners) {
  double reach = 0;
  for (const glm::dvec3& corner : {corners.a, corners.b, corners.c})
    reach = std::max(reach, std::abs(corner.x) + std::abs(corner.y) + std::abs(corner.z));
  return reach * (1 + 16 * kUnit);
}

bool is_in_range(double reach) {
  return reach >= 0x1p-300 && reach <= 0x1p300;
}

Separation separation_from(const Corners& corners, double reach) {
  constexpr double kWide = 64;  // in units of the error of a range that is as narrow as rounding lets it be
  const Separation by_face = proven_by(near_origin(corners), corners, reach);
  if (by_face.range.high - by_face.range.low <= kWide * kDistanceError * reach) return by_face;
  // A needle's plane is hardly known, but its edges are.
  Separation by_edges = proven_by(weighed(nearest_on_edges(glm::dvec3(0), corners), corners), corners, reach);
  by_edges.range.high = std::min(by_edges.range.high, by_face.range.high);
  if (by_face.range.low > by_edges.range.low) {
    by_edges.range.low = by_face.range.low;
    by_edges.direction = by_face.direction;
  }
  return by_edges;
}

}  // namespace vestige
