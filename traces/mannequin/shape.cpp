#include "traces/mannequin/shape.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

namespace vestige::mannequin {

namespace {

using glm::dvec3;

/// Union of two distances, rounded over about `radius`.
double smooth_union(double a, double b, double radius) {
  const double h = std::max(radius - std::abs(a - b), 0.0) / radius;
  return std::min(a, b) - h * h * radius / 4;
}

double smooth_difference(double a, double b, double radius) {
  return -smooth_union(-a, b, radius);
}

double ellipsoid(const dvec3& p, const dvec3& centre, const dvec3& radii) {
  const dvec3 q = p - centre;
  const double k0 = glm::length(q / radii);
  const double k1 = glm::length(q / (radii * radii));
  return k1 == 0 ? -std::min({radii.x, radii.y, radii.z}) : k0 * (k0 - 1) / k1;
}

/// A capsule whose radius changes from `ra` to `rb`.
double round_cone(const dvec3& p, const dvec3& a, const dvec3& b, double ra, double rb) {
  const dvec3 axis = b - a;
  const double h = std::clamp(glm::dot(p - a, axis) / glm::dot(axis, axis), 0.0, 1.0);
  return glm::length(p - a - h * axis) - (ra + h * (rb - ra));
}

/// A cross-section at `at_m` along an axis: an oval with different radii to the side, the front and the back, whose
/// centre lies `forward_m` before the axis.
struct Section {
  double at_m, side_m, front_m, back_m, forward_m;
};

/// A tube through sections, closed by half ellipsoids `cap_m` long.
struct Sweep {
  dvec3 from;
  dvec3 axis;   ///< unit
  dvec3 front;  ///< unit, perpendicular to the axis
  std::vector<Section> sections;
  double cap_m;
  double exponent;  ///< of the oval: 2 an ellipse, more is boxier

  /// Sections between the given ones follow a Catmull-Rom spline.
  Section section_at(double at_m) const {
    std::size_t i = 0;
    while (i + 2 < sections.size() && sections[i + 1].at_m < at_m) ++i;
    const Section& b = sections[i];
    const Section& c = sections[i + 1];
    const Section& a = sections[i == 0 ? 0 : i - 1];
    const Section& d = sections[std::min(i + 2, sections.size() - 1)];
    const double s = std::clamp((at_m - b.at_m) / (c.at_m - b.at_m), 0.0, 1.0);
    const auto spline = [&](double Section::*field) {
      const double width = c.at_m - b.at_m;
      const double slope_b = (c.*field - a.*field) / (c.at_m - a.at_m) * width;
      const double slope_c = (d.*field - b.*field) / (d.at_m - b.at_m) * width;
      const double s2 = s * s;
      const double s3 = s2 * s;
      return (2 * s3 - 3 * s2 + 1) * (b.*field) + (s3 - 2 * s2 + s) * slope_b + (3 * s2 - 2 * s3) * (c.*field) +
             (s3 - s2) * slope_c;
    };
    return {at_m, spline(&Section::side_m), spline(&Section::front_m), spline(&Section::back_m),
            spline(&Section::forward_m)};
  }

  double distance(const dvec3& p) const {
    const dvec3 q = p - from;
    const double along = glm::dot(q, axis);
    const double at_m = std::clamp(along, sections.front().at_m, sections.back().at_m);
    const Section section = section_at(at_m);
    const double forward = glm::dot(q, front) - section.forward_m;
    const double side = std::abs(glm::dot(q, glm::cross(axis, front)));
    const double beyond = along - at_m;
    const double depth_m = forward > 0 ? section.front_m : section.back_m;
    const double oval = std::pow(
        std::pow(side / section.side_m, exponent) + std::pow(std::abs(forward) / depth_m, exponent), 1 / exponent);
    const double rho = std::hypot(oval, beyond / cap_m);
    const double length = std::hypot(side, forward, beyond);
    return rho < 1e-9 ? -std::min(section.side_m, depth_m) : length * (1 - 1 / rho);
  }
};

/// Returns the front of a limb: +z made perpendicular to its axis.
dvec3 front_of(const dvec3& axis) {
  const dvec3 z(0, 0, 1);
  return glm::normalize(z - axis * glm::dot(z, axis));
}

Sweep limb(const dvec3& from, const dvec3& to, double cap_m, std::vector<Section> sections, double exponent = 2) {
  const dvec3 axis = glm::normalize(to - from);
  return {from, axis, front_of(axis), std::move(sections), cap_m, exponent};
}

double torso(const dvec3& p) {
  static const Sweep trunk = limb(dvec3(0, 0, 0), dvec3(0, 1, 0), 0.05,
                                  {{0.86, 0.130, 0.085, 0.080, 0.000},
                                   {0.91, 0.150, 0.098, 0.092, 0.000},
                                   {0.97, 0.154, 0.104, 0.095, 0.002},
                                   {1.04, 0.145, 0.108, 0.086, 0.004},
                                   {1.10, 0.135, 0.106, 0.080, 0.005},
                                   {1.17, 0.139, 0.105, 0.090, 0.003},
                                   {1.25, 0.153, 0.112, 0.106, 0.000},
                                   {1.32, 0.160, 0.112, 0.114, -0.003},
                                   {1.38, 0.150, 0.096, 0.108, -0.008},
                                   {1.43, 0.110, 0.072, 0.086, -0.014},
                                   {1.46, 0.075, 0.056, 0.066, -0.018}},
                                  2.3);
  double d = trunk.distance(p);
  // Shoulder girdle: clavicle, trapezius, shoulder blade.
  d = smooth_union(d, round_cone(p, dvec3(0.03, 1.440, 0.010), dvec3(0.172, 1.418, -0.012), 0.028, 0.044), 0.05);
  d = smooth_union(d, round_cone(p, dvec3(0.016, 1.505, -0.032), dvec3(0.140, 1.426, -0.028), 0.030, 0.034), 0.05);
  d = smooth_union(d, ellipsoid(p, dvec3(0.085, 1.330, -0.080), dvec3(0.065, 0.085, 0.036)), 0.04);
  // Chest, flank under the arm, buttock.
  d = smooth_union(d, ellipsoid(p, dvec3(0.072, 1.316, 0.062), dvec3(0.082, 0.074, 0.050)), 0.050);
  d = smooth_union(d, ellipsoid(p, dvec3(0.120, 1.300, -0.030), dvec3(0.045, 0.100, 0.060)), 0.05);
  d = smooth_union(d, ellipsoid(p, dvec3(0.076, 0.912, -0.056), dvec3(0.082, 0.092, 0.066)), 0.050);
  // Spine and breastbone lie in furrows.
  d = smooth_difference(d, round_cone(p, dvec3(0, 1.000, -0.118), dvec3(0, 1.330, -0.146), 0.018, 0.022), 0.035);
  return smooth_difference(d, round_cone(p, dvec3(0, 1.230, 0.142), dvec3(0, 1.380, 0.132), 0.012, 0.012), 0.034);
}

double head(const dvec3& p) {
  static const Sweep neck = limb(dvec3(0, 1.430, -0.030), dvec3(0, 1.590, 0.000), 0.03,
                                 {{0.00, 0.062, 0.058, 0.054, 0},
                                  {0.06, 0.054, 0.054, 0.052, 0},
                                  {0.12, 0.052, 0.052, 0.052, 0},
                                  {0.16, 0.053, 0.050, 0.054, 0}});
  static const Sweep face = limb(dvec3(0, 0, 0.030), dvec3(0, 1, 0.030), 0.016,
                                 {{1.542, 0.034, 0.052, 0.030, 0},
                                  {1.560, 0.046, 0.060, 0.045, 0},
                                  {1.585, 0.054, 0.062, 0.055, 0},
                                  {1.615, 0.060, 0.062, 0.060, 0},
                                  {1.645, 0.065, 0.060, 0.060, 0},
                                  {1.680, 0.066, 0.058, 0.060, 0}});
  double d = smooth_union(ellipsoid(p, dvec3(0, 1.664, -0.004), dvec3(0.077, 0.088, 0.100)), face.distance(p), 0.03);
  d = smooth_union(d, round_cone(p, dvec3(0, 1.552, 0.078), dvec3(0.012, 1.552, 0.076), 0.015, 0.014), 0.02);  // chin
  d = smooth_union(d, round_cone(p, dvec3(0.010, 1.656, 0.086), dvec3(0.046, 1.655, 0.072), 0.009, 0.009), 0.02);
  d = smooth_difference(d, ellipsoid(p, dvec3(0.033, 1.637, 0.100), dvec3(0.022, 0.014, 0.026)), 0.014);  // eye socket
  d = smooth_union(d, ellipsoid(p, dvec3(0.033, 1.636, 0.070), dvec3(0.015, 0.011, 0.013)), 0.003);       // eye
  d = smooth_union(d, round_cone(p, dvec3(0, 1.650, 0.088), dvec3(0, 1.609, 0.108), 0.007, 0.010), 0.012);  // nose
  d = smooth_union(d, ellipsoid(p, dvec3(0.010, 1.605, 0.098), dvec3(0.008, 0.007, 0.010)), 0.008);
  // Lips, and the line between them.
  d = smooth_union(d, round_cone(p, dvec3(0, 1.5860, 0.0895), dvec3(0.018, 1.5815, 0.0815), 0.0070, 0.0040), 0.008);
  d = smooth_union(d, round_cone(p, dvec3(0, 1.5700, 0.0880), dvec3(0.015, 1.5725, 0.0815), 0.0075, 0.0040), 0.008);
  d = smooth_difference(d, round_cone(p, dvec3(0, 1.5780, 0.0960), dvec3(0.023, 1.5770, 0.0850), 0.0030, 0.0025),
                        0.004);
  d = smooth_union(d, neck.distance(p), 0.025);
  const dvec3 ear(0.078, 1.628, -0.010);
  double pinna = ellipsoid(p, ear, dvec3(0.010, 0.030, 0.018));
  pinna = smooth_difference(pinna, ellipsoid(p, ear + dvec3(0.012, 0.004, 0.006), dvec3(0.008, 0.018, 0.010)), 0.006);
  return smooth_union(d, pinna, 0.006);
}

double leg(const dvec3& p) {
  const Landmarks& at = landmarks();
  static const Sweep thigh = limb(at.hip, at.knee, 0.11,
                                  {{-0.02, 0.078, 0.084, 0.080, 0.002},
                                   {0.06, 0.083, 0.088, 0.084, 0.000},
                                   {0.14, 0.080, 0.084, 0.080, 0.002},
                                   {0.23, 0.071, 0.074, 0.070, 0.004},
                                   {0.33, 0.059, 0.060, 0.058, 0.004},
                                   {0.43, 0.051, 0.052, 0.052, 0.000}});
  static const Sweep calf = limb(at.knee, at.ankle, 0.03,
                                 {{-0.02, 0.050, 0.050, 0.050, 0.000},
                                  {0.05, 0.050, 0.046, 0.056, -0.002},
                                  {0.12, 0.053, 0.043, 0.066, -0.006},
                                  {0.18, 0.050, 0.041, 0.062, -0.006},
                                  {0.26, 0.040, 0.037, 0.046, -0.002},
                                  {0.34, 0.031, 0.033, 0.036, 0.000},
                                  {0.41, 0.032, 0.036, 0.036, 0.000}});
  double d = smooth_union(thigh.distance(p), calf.distance(p), 0.03);
  d = smooth_union(d, ellipsoid(p, at.knee + dvec3(0, 0.005, 0.040), dvec3(0.030, 0.036, 0.018)), 0.02);
  // Foot: heel, instep, ball, toes; ankle bones.
  const dvec3 outwards(0.09, 0, 1);
  const auto along_foot = [&](double forward_m, double y) {
    return dvec3(at.ankle.x, y, at.ankle.z) + forward_m * outwards;
  };
  double foot = ellipsoid(p, along_foot(-0.028, 0.034), dvec3(0.033, 0.040, 0.036));
  foot = smooth_union(foot, round_cone(p, along_foot(0.010, 0.066), along_foot(0.120, 0.026), 0.036, 0.026), 0.03);
  foot = smooth_union(foot, round_cone(p, along_foot(-0.020, 0.026), along_foot(0.110, 0.018), 0.032, 0.030), 0.03);
  foot = smooth_union(foot, ellipsoid(p, along_foot(0.130, 0.020), dvec3(0.047, 0.026, 0.050)), 0.03);
  // Toes, the big one inside.
  constexpr double kToes[5][4] = {{-0.030, 0.188, 0.0150, 0.0135},
                                  {-0.008, 0.190, 0.0115, 0.0090},
                                  {0.009, 0.182, 0.0110, 0.0085},
                                  {0.024, 0.172, 0.0105, 0.0080},
                                  {0.037, 0.158, 0.0100, 0.0080}};
  for (const auto& toe : kToes)
    foot = smooth_union(foot,
                        round_cone(p, along_foot(0.140, 0.020) + dvec3(toe[0], 0, 0),
                                   along_foot(toe[1], 0.0125) + dvec3(toe[0], 0, 0), toe[2], toe[3]),
                        0.010);
  d = smooth_union(d, foot, 0.03);
  d = smooth_union(d, ellipsoid(p, at.ankle + dvec3(0.022, -0.004, -0.004), dvec3(0.014, 0.016, 0.014)), 0.012);
  d = smooth_union(d, ellipsoid(p, at.ankle + dvec3(-0.022, 0.006, 0.002), dvec3(0.014, 0.016, 0.014)), 0.012);
  // The sole: nearly flat, with an arch on the inside.
  const dvec3 q = p - along_foot(0.06, 0);
  const double floor_m =
      0.6 * q.x * q.x + 0.08 * q.z * q.z + 0.010 * std::exp(-500 * q.z * q.z) * std::clamp(-q.x / 0.03, 0.0, 1.0);
  return -smooth_union(-d, p.y - floor_m, 0.012);
}

double hand(const dvec3& p) {
  const Landmarks& at = landmarks();
  const dvec3 along = glm::normalize(at.knuckles - at.wrist);
  const dvec3 thumbward = front_of(along);
  const dvec3 palmward = glm::cross(along, thumbward);
  static const Sweep palm = limb(at.wrist, at.knuckles, 0.012,
                                 {{-0.01, 0.019, 0.026, 0.026, 0},
                                  {0.02, 0.019, 0.030, 0.030, 0},
                                  {0.05, 0.018, 0.039, 0.038, 0},
                                  {0.085, 0.0135, 0.041, 0.040, 0}},
                                 2.5);
  double d = palm.distance(p);
  struct Finger {
    double side_m, splay_rad, length_m, radius_m;
  };
  constexpr Finger kFingers[4] = {{0.0310, 0.21, 0.074, 0.0094},
                                  {0.0105, 0.06, 0.083, 0.0096},
                                  {-0.0105, -0.09, 0.077, 0.0092},
                                  {-0.0305, -0.26, 0.060, 0.0084}};
  for (const Finger& finger : kFingers) {
    const dvec3 out = along * std::cos(finger.splay_rad) + thumbward * std::sin(finger.splay_rad);
    const auto curled = [&](double angle) { return out * std::cos(angle) + palmward * std::sin(angle); };
    const dvec3 base = at.wrist + 0.080 * along + finger.side_m * thumbward;
    const dvec3 middle = base + 0.5 * finger.length_m * curled(0.12) + 0.010 * out;
    const dvec3 tip = middle + 0.5 * finger.length_m * curled(0.40);
    double digit = round_cone(p, base, middle, finger.radius_m + 0.0005, finger.radius_m - 0.001);
    digit = smooth_union(digit, round_cone(p, middle, tip, finger.radius_m - 0.001, finger.radius_m - 0.0025), 0.004);
    d = smooth_union(d, digit, 0.008);
  }
  const dvec3 root = at.wrist + 0.022 * along + 0.018 * thumbward + 0.008 * palmward;
  const dvec3 knuckle = root + 0.040 * glm::normalize(0.75 * along + 0.62 * thumbward + 0.25 * palmward);
  const dvec3 tip = knuckle + 0.046 * glm::normalize(0.92 * along + 0.36 * thumbward + 0.20 * palmward);
  d = smooth_union(d, round_cone(p, root, knuckle, 0.017, 0.0125), 0.012);
  return smooth_union(d, round_cone(p, knuckle, tip, 0.0120, 0.0085), 0.008);
}

double arm(const dvec3& p) {
  const Landmarks& at = landmarks();
  static const Sweep upper = limb(at.shoulder, at.elbow, 0.03,
                                  {{-0.01, 0.050, 0.052, 0.052, 0.000},
                                   {0.06, 0.050, 0.049, 0.050, 0.000},
                                   {0.13, 0.044, 0.047, 0.045, 0.000},
                                   {0.20, 0.039, 0.040, 0.041, 0.000},
                                   {0.285, 0.036, 0.035, 0.036, 0.000}});
  static const Sweep fore = limb(at.elbow, at.wrist, 0.02,
                                 {{-0.01, 0.035, 0.035, 0.036, 0.000},
                                  {0.05, 0.039, 0.039, 0.037, 0.000},
                                  {0.11, 0.036, 0.037, 0.035, 0.000},
                                  {0.18, 0.027, 0.030, 0.030, 0.000},
                                  {0.25, 0.020, 0.027, 0.027, 0.000}});
  double d = smooth_union(upper.distance(p), fore.distance(p), 0.02);
  d = smooth_union(d, ellipsoid(p, at.shoulder + dvec3(0.012, -0.004, 0), dvec3(0.052, 0.054, 0.056)),
                   0.03);  // deltoid
  return smooth_union(d, hand(p), 0.015);
}

}  // namespace

const Landmarks& landmarks() {
  static const Landmarks at = [] {
    Landmarks l;
    l.pelvis = {0, 0.950, -0.010};
    l.lumbar = {0, 1.080, -0.015};
    l.thorax = {0, 1.230, -0.015};
    l.neck = {0, 1.475, -0.025};
    l.head = {0, 1.575, -0.005};
    const double below = glm::radians(42.0);
    const dvec3 arm_axis(std::cos(below), -std::sin(below), 0);
    const dvec3 forearm_axis = glm::normalize(arm_axis + dvec3(0, 0, 0.10));
    l.clavicle = {0.025, 1.430, -0.010};
    l.shoulder = {0.178, 1.392, -0.015};
    l.elbow = l.shoulder + 0.285 * arm_axis;
    l.wrist = l.elbow + 0.255 * forearm_axis;
    l.knuckles = l.wrist + 0.085 * forearm_axis;
    l.hip = {0.092, 0.915, 0.000};
    l.knee = {0.106, 0.495, 0.008};
    l.ankle = {0.118, 0.085, -0.022};
    l.ball = {0.130, 0.022, 0.110};
    l.toe_tip = {0.136, 0.014, 0.180};
    return l;
  }();
  return at;
}

double signed_distance(const dvec3& p) {
  double d = smooth_union(torso(p), head(p), 0.04);
  d = smooth_union(d, leg(p), 0.060);
  return smooth_union(d, arm(p), 0.045);
}

bool on_arm(const dvec3& p) {
  const Landmarks& at = landmarks();
  constexpr double kOutside_m = 0.30;  // from the body's middle: only arms reach there
  if (p.x > kOutside_m) return true;
  constexpr double kReach_m = 0.10;  // from the arm's axis: farther away is the flank
  const dvec3 axis = glm::normalize(at.elbow - at.shoulder);
  const double along = glm::dot(p - at.shoulder, axis);
  return along > 0 && p.x > at.shoulder.x - 0.01 && glm::length(p - at.shoulder - along * axis) < kReach_m;
}

}  // namespace vestige::mannequin
