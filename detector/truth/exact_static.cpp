#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <utility>

#include "detector/truth/truth.hpp"
#include "detector/truth/whole_vector.hpp"

namespace vestige::exact {

namespace {

/// A time as numerator / denominator; the denominator is positive.
struct Fraction {
  Whole numerator;
  Whole denominator;

  friend bool operator<(const Fraction& a, const Fraction& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  }
};

/// The times within [0, 1] that meet all conditions so far. A condition is about a quantity that changes linearly,
/// given by its values at 0 and at 1.
class Times {
 public:
  bool none() const { return none_; }
  const Fraction& first() const { return low_; }

  void keep_non_negative(const Whole& at_0, const Whole& at_1) {
    const int sign_0 = sign_of(at_0);
    const int sign_1 = sign_of(at_1);
    if (none_ || (sign_0 >= 0 && sign_1 >= 0)) return;
    if (sign_0 < 0 && sign_1 < 0) {
      none_ = true;
      return;
    }
    Fraction zero = {at_0, at_0 - at_1};
    if (sign_0 < 0) {
      zero = {-at_0, at_1 - at_0};
      if (low_ < zero) low_ = std::move(zero);
    } else if (zero < high_) {
      high_ = std::move(zero);
    }
    none_ = high_ < low_;
  }

  void keep_zero(const Whole& at_0, const Whole& at_1) {
    keep_non_negative(at_0, at_1);
    keep_non_negative(-at_0, -at_1);
  }

 private:
  Fraction low_ = {0, 1};
  Fraction high_ = {1, 1};
  bool none_ = false;
};

/// The input, as integer multiples of one length.
struct Question {
  Vector start;
  Vector end;
  std::array<Vector, 3> corner;
};

Question question_of(const Way& way, const Corners& triangle) {
  std::array<double, 15> values = {};
  std::size_t next = 0;
  for (const glm::dvec3* point : {&way.start, &way.end, &triangle.a, &triangle.b, &triangle.c})
    for (int axis = 0; axis < 3; ++axis) values[next++] = (*point)[axis];
  std::array<Whole, 15> whole = whole_multiples(values);
  const auto point = [&whole](std::size_t i) {
    return Vector{std::move(whole[3 * i]), std::move(whole[3 * i + 1]), std::move(whole[3 * i + 2])};
  };
  Question question;
  question.start = point(0);
  question.end = point(1);
  for (std::size_t i = 0; i < 3; ++i) question.corner[i] = point(2 + i);
  return question;
}

/// Keeps the times at which the way is within the triangle's prism. The triangle is the intersection of the plane with
/// the three half-spaces that stand on its edges.
void stay_within(const Question& q, const Vector& normal, Times& times) {
  for (std::size_t i = 0; i < 3 && !times.none(); ++i) {
    const Vector inward = cross(normal, minus(q.corner[(i + 1) % 3], q.corner[i]));
    times.keep_non_negative(dot(inward, minus(q.start, q.corner[i])), dot(inward, minus(q.end, q.corner[i])));
  }
}

/// Keeps the times at which the way is on a triangle without area. Such a triangle is the line between its first and
/// its last corner in lexicographic order, which is their order along the line; or it is one point.
void stay_on_line(const Question& q, Times& times) {
  const auto [first, last] = std::minmax_element(q.corner.begin(), q.corner.end());
  const Vector line = minus(*last, *first);
  const Vector from_first_0 = minus(q.start, *first);
  const Vector from_first_1 = minus(q.end, *first);
  if (is_zero(line)) {
    for (std::size_t axis = 0; axis < 3; ++axis) times.keep_zero(from_first_0[axis], from_first_1[axis]);
    return;
  }
  const Vector away_0 = cross(line, from_first_0);
  const Vector away_1 = cross(line, from_first_1);
  for (std::size_t axis = 0; axis < 3; ++axis) times.keep_zero(away_0[axis], away_1[axis]);
  times.keep_non_negative(dot(line, from_first_0), dot(line, from_first_1));
  times.keep_non_negative(dot(line, minus(*last, q.start)), dot(line, minus(*last, q.end)));
}

/// Returns whether all of the way lies beyond all of the triangle along an axis.
bool apart(const Way& way, const Corners& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [way_low, way_high] = std::minmax(way.start[axis], way.end[axis]);
    const auto [low, high] = std::minmax({triangle.a[axis], triangle.b[axis], triangle.c[axis]});
    if (way_high < low || way_low > high) return true;
  }
  return false;
}

}  // namespace

// Every condition for the way's point to be on the triangle is linear in time. So the times of contact are the part of
// [0, 1] that remains after each condition cuts it. The code never computes an intersection.
std::optional<FirstContact> static_contact(const Way& way, const Corners& triangle) {
  if (apart(way, triangle)) return std::nullopt;
  const Question q = question_of(way, triangle);
  const Vector normal = cross(minus(q.corner[1], q.corner[0]), minus(q.corner[2], q.corner[0]));
  Times times;
  int side = 0;
  if (is_zero(normal)) {
    stay_on_line(q, times);
  } else {
    const Whole height_0 = dot(normal, minus(q.start, q.corner[0]));
    const Whole height_1 = dot(normal, minus(q.end, q.corner[0]));
    times.keep_zero(height_0, height_1);
    stay_within(q, normal, times);
    side = height_0.compare(height_1);  // a way downwards through the plane comes from the front
  }
  if (times.none()) return std::nullopt;
  return FirstContact{rounded_quotient(times.first().numerator, times.first().denominator),
                      static_cast<std::int8_t>((side > 0) - (side < 0))};
}

}  // namespace vestige::exact
