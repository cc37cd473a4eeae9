#include "tests/support/pairs/contact_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "detector/nearest_in_triangle.hpp"

namespace vestige::test {

namespace {

using Random = std::mt19937_64;

/// Uniform in [0, 1), by our own formula: the standard's distributions differ between libraries.
double share(Random& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}
int whole(Random& random, int least, int greatest) {
  return least + static_cast<int>(random() % static_cast<std::uint64_t>(greatest - least + 1));
}
bool one_in(Random& random, int n) {
  return whole(random, 1, n) == 1;
}
/// Not std::pow: its last bit depends on the machine.
double power_of_ten(int exponent) {
  double power = 1;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  return exponent < 0 ? 1 / power : power;
}
double coordinate(Random& random) {
  return 2 * share(random) - 1;
}
glm::dvec3 point(Random& random) {
  const double x = coordinate(random);
  const double y = coordinate(random);
  const double z = coordinate(random);
  return {x, y, z};
}
glm::dvec3 whole_point(Random& random, int reach) {
  const int x = whole(random, -reach, reach);
  const int y = whole(random, -reach, reach);
  const int z = whole(random, -reach, reach);
  return {x, y, z};
}
Corners corners(Random& random) {
  const glm::dvec3 a = point(random);
  const glm::dvec3 b = point(random);
  return {a, b, point(random)};
}
Corners whole_corners(Random& random, int reach) {
  const glm::dvec3 a = whole_point(random, reach);
  const glm::dvec3 b = whole_point(random, reach);
  return {a, b, whole_point(random, reach)};
}

template <typename Change>
void for_each_point(ContactCase& c, const Change& change) {
  for (glm::dvec3* x :
       {&c.way.start, &c.way.end, &c.before.a, &c.before.b, &c.before.c, &c.after.a, &c.after.b, &c.after.c})
    change(*x);
}
template <typename Change>
void for_each_coordinate(ContactCase& c, const Change& change) {
  for_each_point(c, [&change](glm::dvec3& x) {
    for (int axis = 0; axis < 3; ++axis) change(x[axis]);
  });
}

glm::dvec3 between(const glm::dvec3& from, const glm::dvec3& to, double t) {
  return (1 - t) * from + t * to;
}
Corners at(const ContactCase& c, double t) {
  return {between(c.before.a, c.after.a, t), between(c.before.b, c.after.b, t), between(c.before.c, c.after.c, t)};
}

/// Makes the way pass `target` at t, nearly: by its end, or by its start where t is 0.
void aim(ContactCase& c, const glm::dvec3& target, double t) {
  if (t <= 0) {
    c.way.start = target;
  } else {
    c.way.end = c.way.start + (target - c.way.start) / t;
  }
}

/// A triangle that rests, moves a little or moves far, and a way from anywhere.
ContactCase moving(Random& random) {
  ContactCase c = {{point(random), point(random)}, corners(random), {}};
  c.after = c.before;
  const int kind = whole(random, 0, 2);
  if (kind == 1)
    for (glm::dvec3* x : {&c.after.a, &c.after.b, &c.after.c}) *x += 0.01 * point(random);
  if (kind == 2) c.after = corners(random);
  return c;
}

/// When the way is to meet its target: now, at an end, or between.
double time_of_meeting(Random& random) {
  const int kind = whole(random, 0, 3);
  return kind == 0 ? 0 : (kind == 1 ? 1 : (kind == 2 ? 0.5 : std::max(share(random), 0x1p-10)));
}

ContactCase aimed_at_vertex(Random& random) {
  ContactCase c = moving(random);
  const double t = one_in(random, 2) ? 1 : time_of_meeting(random);
  aim(c, at(c, t).a, t);
  if (one_in(random, 2)) c.way.end = between(c.way.start, c.way.end, 2);
  return c;
}

ContactCase aimed_at_edge(Random& random) {
  ContactCase c = moving(random);
  const double t = time_of_meeting(random);
  const Corners then = at(c, t);
  aim(c, between(then.a, then.b, one_in(random, 2) ? 0.5 : share(random)), t);
  if (one_in(random, 2)) c.way.end = between(c.way.start, c.way.end, 2);
  return c;
}

ContactCase ending_on_surface(Random& random) {
  ContactCase c = moving(random);
  const double t = one_in(random, 2) ? 0 : 1;
  const Corners then = at(c, t);
  aim(c, between(then.a, between(then.b, then.c, share(random)), share(random)), t);
  return c;
}

/// All in a plane z = px + qy + r (then in axes exchanged), which may rise with time: exactly, on small whole numbers.
ContactCase coplanar(Random& random) {
  constexpr int kReach = 8;
  ContactCase c = {{whole_point(random, kReach), whole_point(random, kReach)},
                   whole_corners(random, kReach),
                   whole_corners(random, kReach)};
  if (one_in(random, 2)) c.after = c.before;
  const int p = whole(random, -3, 3);
  const int q = whole(random, -3, 3);
  const int rise = one_in(random, 2) ? 0 : whole(random, -5, 5);
  const auto lift = [p, q](glm::dvec3& x, int height) { x.z = p * x.x + q * x.y + height; };
  for (glm::dvec3* x : {&c.way.start, &c.before.a, &c.before.b, &c.before.c}) lift(*x, 0);
  for (glm::dvec3* x : {&c.way.end, &c.after.a, &c.after.b, &c.after.c}) lift(*x, rise);
  const int turn = whole(random, 0, 2);
  for_each_point(c, [turn](glm::dvec3& x) {
    for (int i = 0; i < turn; ++i) x = {x.z, x.x, x.y};
  });
  return c;
}

ContactCase grazing(Random& random) {
  ContactCase c = moving(random);
  const double t = share(random);
  const Corners then = at(c, t);
  const glm::dvec3 target = between(then.a, between(then.b, then.c, share(random)), share(random));
  const glm::dvec3 along = then.b - then.a;
  const glm::dvec3 off = power_of_ten(whole(random, -16, -4)) * point(random);  // from 0.005 degrees to rounding
  c.way.start = target - t * (along + off);
  c.way.end = target + (1 - t) * (along + off);
  return c;
}

/// Corners nearly in line: a needle where the nearest two are close, a cap where one lies between.
Corners thin(Random& random) {
  Corners thin = corners(random);
  const double off = power_of_ten(whole(random, -17, -3));
  thin.c = between(thin.a, thin.b, one_in(random, 2) ? share(random) : 1) + off * point(random);
  return thin;
}

ContactCase thin_triangle(Random& random) {
  ContactCase c = moving(random);
  c.before = thin(random);
  c.after = one_in(random, 2) ? c.before : thin(random);
  const double t = time_of_meeting(random);
  const Corners then = at(c, t);
  aim(c, between(then.a, between(then.b, then.c, share(random)), share(random)), t);
  return c;
}

ContactCase without_length(Random& random) {
  ContactCase c = one_in(random, 2) ? aimed_at_edge(random) : ending_on_surface(random);
  (one_in(random, 2) ? c.way.start : c.way.end) = one_in(random, 2) ? c.way.end : c.way.start;
  c.way.end = c.way.start;
  if (one_in(random, 4)) c.way.start = c.way.end = c.before.b;
  return c;
}

Corners without_area(Random& random, int reach) {
  Corners flat;
  flat.a = whole_point(random, reach);
  const glm::dvec3 step = whole_point(random, 3);
  flat.b = flat.a + static_cast<double>(whole(random, -2, 2)) * step;
  flat.c = flat.a + static_cast<double>(whole(random, -2, 2)) * step;
  return flat;
}

ContactCase degenerate(Random& random) {
  ContactCase c;
  c.before = without_area(random, 3);
  c.after = one_in(random, 2) ? c.before : without_area(random, 3);
  c.way = {whole_point(random, 4), whole_point(random, 4)};
  const double t = whole(random, 0, 4) / 4.0;
  const Corners then = at(c, t);
  if (one_in(random, 2)) aim(c, between(then.a, then.b, 0.5), t);
  if (one_in(random, 4)) aim(c, then.c, t);
  return c;
}

/// Small whole numbers: contacts at ends, edges and corners, and roots in common, are frequent and exact.
ContactCase small_integers(Random& random) {
  const int reach = whole(random, 1, 4);
  ContactCase c = {{whole_point(random, reach), whole_point(random, reach)}, whole_corners(random, reach), {}};
  c.after = one_in(random, 4) ? c.before : whole_corners(random, reach);
  return c;
}

/// A triangle that has no area at some time within the frame, when the point may be on it.
ContactCase collapse(Random& random) {
  ContactCase c;
  const Corners then = without_area(random, 2);
  const Corners motion = whole_corners(random, 2);
  const glm::dvec3 target =
      one_in(random, 3) ? then.c : between(then.a, then.b, static_cast<double>(whole(random, 0, 4)) / 2 - 0.5);
  const glm::dvec3 speed = whole_point(random, 3);
  const int before = whole(random, 0, 3);
  const int after = whole(random, 0, 3);
  const auto back = static_cast<double>(-before);
  const auto on = static_cast<double>(after);
  c.before = {then.a + back * motion.a, then.b + back * motion.b, then.c + back * motion.c};
  c.after = {then.a + on * motion.a, then.b + on * motion.b, then.c + on * motion.c};
  c.way = {target + back * speed, target + on * speed};
  if (one_in(random, 8)) c.way = {whole_point(random, 4), whole_point(random, 4)};
  return c;
}

/// The point touches the plane and turns back: with b - a = (1, 0, m), c - a = (0, 1, 0) and x - a = (p, q, r), f is
/// r - m p; here that is a square, or the product of two near roots.
ContactCase tangent(Random& random) {
  const int slope = whole(random, 1, 7);
  const int root = whole(random, 0, slope);
  const int apart = one_in(random, 2) ? 0 : whole(random, -1, 1);
  const double fine = std::ldexp(1.0, -whole(random, 0, 40));
  const auto m = [&](int t) { return static_cast<double>(slope * t - root); };
  const double touch = whole(random, 0, 8) / 8.0;
  const double q = whole(random, -1, 8) / 8.0;
  const glm::dvec3 a = whole_point(random, 2);
  ContactCase c;
  const auto place = [&](int t, glm::dvec3& x, Corners& corner) {
    corner = {a, a + glm::dvec3(1, 0, m(t)), a + glm::dvec3(0, 1, 0)};
    x = a + glm::dvec3(touch - m(t) + apart * fine, q, touch * m(t));
  };
  place(0, c.way.start, c.before);
  place(1, c.way.end, c.after);
  const int turn = whole(random, 0, 2);
  for_each_point(c, [turn](glm::dvec3& x) {
    for (int i = 0; i < turn; ++i) x = {x.z, x.x, x.y};
  });
  return c;
}

/// Whole multiples of the smallest number that a double or an fp32 holds.
ContactCase denormal(Random& random, ContactCase c) {
  const double unit = one_in(random, 2) ? std::numeric_limits<double>::denorm_min()
                                        : static_cast<double>(std::numeric_limits<float>::denorm_min());
  const double digits = std::ldexp(1.0, whole(random, 0, 20));
  for_each_coordinate(c, [&](double& x) { x = std::round(x * digits) * unit; });
  return c;
}

/// Every exponent that a double has: differences overflow, products vanish.
ContactCase extreme(Random& random, ContactCase c) {
  const int kind = whole(random, 0, 3);
  const int shift = whole(random, -1060, 1015);
  for_each_coordinate(c, [&](double& x) {
    if (kind == 0) x = std::ldexp(x, whole(random, -1080, 1023));
    if (kind == 1) x = std::ldexp(x, shift + whole(random, -3, 3));
    if (kind == 2) x = std::ldexp(x, shift);
    if (kind == 3 && one_in(random, 4)) x = std::ldexp(x, whole(random, -80, 80));
    if (!std::isfinite(x)) x = std::copysign(std::numeric_limits<double>::max(), x);
  });
  return c;
}

enum Family : std::size_t {
  kAnywhere,
  kVertex,
  kEdge,
  kEndpoint,
  kCoplanar,
  kGrazing,
  kNeedle,
  kZeroLength,
  kDegenerate,
  kInteger,
  kCollapse,
  kTangent,
  kPlainFamilies,  ///< how many there are of those that change no others
  kUlp = kPlainFamilies,
  kScale,
  kOffset,
  kDenormal,
  kExtreme,
  kFamilies
};

constexpr std::array<std::string_view, kFamilies> kNames = {
    "anywhere", "vertex",   "edge",    "endpoint", "coplanar", "grazing", "needle",   "zero_length", "degenerate",
    "integer",  "collapse", "tangent", "ulp",      "scale",    "offset",  "denormal", "extreme"};

ContactCase plain_case(std::size_t family, Random& random) {
  switch (family) {
    case kVertex:
      return aimed_at_vertex(random);
    case kEdge:
      return aimed_at_edge(random);
    case kEndpoint:
      return ending_on_surface(random);
    case kCoplanar:
      return coplanar(random);
    case kGrazing:
      return grazing(random);
    case kNeedle:
      return thin_triangle(random);
    case kZeroLength:
      return without_length(random);
    case kDegenerate:
      return degenerate(random);
    case kInteger:
      return small_integers(random);
    case kCollapse:
      return collapse(random);
    case kTangent:
      return tangent(random);
    default:
      return moving(random);
  }
}

void nudge(Random& random, ContactCase& c, bool fp32) {
  const int rarity = whole(random, 2, 24);
  for_each_coordinate(c, [&](double& x) {
    if (!one_in(random, rarity)) return;
    const double towards = one_in(random, 2) ? HUGE_VAL : -HUGE_VAL;
    if (x == 0 && !one_in(random, 64)) {  // the neighbours of 0 are as far away as any, in size
      x = std::copysign(std::ldexp(1.0, fp32 ? -24 : -53), towards);
      return;
    }
    x = fp32 ? static_cast<double>(std::nextafter(static_cast<float>(x), static_cast<float>(towards)))
             : std::nextafter(x, towards);
  });
}

void round_to_fp32(ContactCase& c) {
  for_each_coordinate(c, [](double& x) {
    constexpr auto kLargest = static_cast<double>(std::numeric_limits<float>::max());
    x = static_cast<double>(static_cast<float>(std::clamp(x, -kLargest, kLargest)));
  });
}

double distance_to(const glm::dvec3& x, const Corners& triangle) {
  return glm::distance(x, weighed(nearest_in_triangle(x, triangle), triangle));
}

double radius_of(Random& random, const ContactCase& c) {
  const double size = std::max(glm::distance(c.before.a, c.before.b), glm::distance(c.after.a, c.after.c));
  switch (whole(random, 0, 8)) {
    case 0:
      return glm::distance(c.way.start, c.before.a);
    case 1:
      return glm::distance(c.way.end, c.after.b);
    case 2:
      return distance_to(c.way.start, c.before);
    case 3:
      return distance_to(c.way.end, c.after);
    case 4:
      return std::numeric_limits<float>::denorm_min();
    case 5:
      return 1000 * size;
    case 6:
      return whole(random, 1, 6) / 2.0;
    default:
      return size * power_of_ten(whole(random, -4, 0)) * share(random);
  }
}

bool is_radius(double radius) {
  return radius > 0 && std::isfinite(radius);
}

}  // namespace

std::span<const std::string_view> case_families() {
  return kNames;
}

CaseGenerator::CaseGenerator(std::string_view family, std::uint64_t seed)
    : family_(static_cast<std::size_t>(std::ranges::find(kNames, family) - kNames.begin())),
      random_(seed * kFamilies + family_) {
  if (family_ == kFamilies) throw std::invalid_argument("no family of cases is named " + std::string(family));
}

ContactCase CaseGenerator::next() {
  Random& random = random_;
  const bool fp32 = one_in(random, 2);
  const std::size_t plain = family_ < kPlainFamilies
                                ? family_
                                : static_cast<std::size_t>(whole(random, 0, static_cast<int>(kPlainFamilies) - 1));
  ContactCase c = plain_case(plain, random);
  if (family_ == kScale) {
    const double scale = power_of_ten(whole(random, -6, 6));
    for_each_point(c, [scale](glm::dvec3& x) { x *= scale; });
  }
  if (family_ == kOffset) {
    const glm::dvec3 offset = power_of_ten(whole(random, 0, 7)) * whole_point(random, 1);
    for_each_point(c, [offset](glm::dvec3& x) { x += offset; });
  }
  if (family_ == kDenormal) c = denormal(random, c);
  if (family_ == kExtreme) c = extreme(random, c);
  if (fp32) round_to_fp32(c);
  if (family_ == kUlp) nudge(random, c, fp32);
  return c;
}

SphereCase CaseGenerator::next_sphere() {
  ContactCase c = next();
  Random& random = random_;
  double radius = radius_of(random, c);
  if (one_in(random, 4)) radius = std::nextafter(radius, one_in(random, 2) ? 0 : HUGE_VAL);
  if (one_in(random, 2)) radius = double{static_cast<float>(radius)};
  if (!is_radius(radius)) radius = whole(random, 1, 4) / 2.0;
  const glm::dvec3 normal = glm::cross(c.after.b - c.after.a, c.after.c - c.after.a);
  const double length = glm::length(normal);
  if (one_in(random, 2) && is_radius(length)) {
    const glm::dvec3 shift = radius / length * normal;
    c.way = {c.way.start + shift, c.way.end + shift};
  }
  const auto is_finite = [](const glm::dvec3& x) {
    return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
  };
  if (!is_finite(c.way.start)) c.way.start = glm::dvec3(0);
  if (!is_finite(c.way.end)) c.way.end = c.way.start;
  if (one_in(random, 2)) {  // as all that a trace brings
    round_to_fp32(c);
    const double rounded = double{static_cast<float>(radius)};
    if (is_radius(rounded)) radius = rounded;
  }
  return {{c.way, radius}, c.before, c.after};
}

}  // namespace vestige::test
