#include "traces/mannequin/animations.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "traces/mannequin/shape.hpp"

namespace vestige::mannequin {

namespace {

using glm::dquat;
using glm::dvec3;

constexpr double kTwoPi = 2 * std::numbers::pi;

dquat turn(double angle_deg, const dvec3& axis) {
  return glm::angleAxis(glm::radians(angle_deg), glm::normalize(axis));
}

const dvec3 kX(1, 0, 0);
const dvec3 kY(0, 1, 0);
const dvec3 kZ(0, 0, 1);

enum class Side { kLeft, kRight };
constexpr Side kSides[] = {Side::kLeft, Side::kRight};

/// Sets a pose by angles in degrees, with anatomical names; positive is to the front, up and inwards.
class Poser {
 public:
  JointPose& pose() { return pose_; }

  void set(const std::string& name, const dquat& rotation) { pose_.rotations[joint(name)] = rotation; }

  /// Bends the trunk forwards and to its left, and turns it to its left. The joints of the spine share the angles.
  void trunk(double forward_deg, double side_deg, double twist_deg) {
    const auto part = [&](double share) {
      return turn(share * twist_deg, kY) * turn(share * forward_deg, kX) * turn(-share * side_deg, kZ);
    };
    set("lumbar_spine", part(0.5));
    set("thoracic_spine", part(0.5));
  }

  void head(double nod_deg, double turn_deg) {
    set("neck", turn(0.4 * turn_deg, kY) * turn(0.4 * nod_deg, kX));
    set("head", turn(0.6 * turn_deg, kY) * turn(0.6 * nod_deg, kX));
  }

  /// Lets the arm hang at `below_deg` below the horizontal (rest: 42) and swing forwards, and flexes the elbow. The
  /// collar bone takes a part of the raising.
  void arm(Side side, double below_deg, double forward_deg, double elbow_deg) {
    const double lift_deg = 42 - below_deg;
    set(name("clavicle", side), turn(0.2 * mirror(side) * lift_deg, kZ));
    set(name("upper_arm", side), turn(-forward_deg, kX) * turn(0.8 * mirror(side) * lift_deg, kZ));
    elbow(side, elbow_deg);
  }

  /// Points the upper arm along `direction`, in the chest's frame (for the left side; mirrored for the right).
  void point_arm(Side side, const dvec3& direction, double share, double elbow_deg) {
    const Landmarks& at = landmarks();
    const dvec3 rest = glm::normalize(at.elbow - at.shoulder);
    const dvec3 down = turn(-34, kZ) * rest;
    const dvec3 aim = glm::normalize(glm::mix(down, glm::normalize(direction), share));
    const auto between = [&](const dvec3& to) {
      return glm::angleAxis(std::acos(std::clamp(glm::dot(rest, to), -1.0, 1.0)), glm::normalize(glm::cross(rest, to)));
    };
    const dquat whole = between(aim);
    const dquat collar = glm::slerp(dquat(1, 0, 0, 0), whole, 0.2);
    set(name("clavicle", side), mirrored(side, collar));
    set(name("upper_arm", side), mirrored(side, glm::inverse(collar) * whole));
    elbow(side, elbow_deg);
  }

  void elbow(Side side, double flex_deg) {
    const Landmarks& at = landmarks();
    const dvec3 axis = glm::cross(at.elbow - at.shoulder, kZ);
    set(name("forearm", side), mirrored(side, turn(flex_deg, axis)));
    set(name("hand", side), mirrored(side, turn(0.1 * flex_deg, axis)));
  }

  void leg(Side side, double forward_deg, double knee_deg, double toes_up_deg, double outwards_deg = 0) {
    set(name("thigh", side), turn(-forward_deg, kX) * turn(mirror(side) * outwards_deg, kZ));
    set(name("shin", side), turn(knee_deg, kX));
    set(name("foot", side), turn(-toes_up_deg, kX) * turn(-mirror(side) * outwards_deg, kZ));
  }

  void toes(Side side, double up_deg) { set(name("toes", side), turn(-up_deg, kX)); }

  /// Lowers or raises everything until the lowest point of the feet touches the ground.
  void stand() {
    const Landmarks& at = landmarks();
    double lowest = 1e9;
    for (const Side side : kSides) {
      const auto height = [&](const char* bone, dvec3 point) {
        point.x *= mirror(side);
        return posed(pose_, joint(name(bone, side)), point).y;
      };
      lowest = std::min({lowest, height("foot", {at.ankle.x, 0, at.ankle.z - 0.045}),
                         height("foot", {at.ball.x, 0, at.ball.z}), height("toes", {at.toe_tip.x, 0, at.toe_tip.z})});
    }
    pose_.root_m.y -= lowest;
  }

  static double mirror(Side side) { return side == Side::kLeft ? 1 : -1; }

 private:
  static std::string name(const char* bone, Side side) {
    return std::string(bone) + (side == Side::kLeft ? "_left" : "_right");
  }
  static dquat mirrored(Side side, const dquat& q) { return side == Side::kLeft ? q : dquat(q.w, q.x, -q.y, -q.z); }

  JointPose pose_ = rest_pose();
};

Motion make_motion(const std::string& name, double duration_s, int keys,
                   const std::function<void(double phase, Poser& poser)>& at) {
  Motion motion = {name, duration_s, {}};
  for (int key = 0; key <= keys; ++key) {
    Poser poser;
    at(static_cast<double>(key % keys) / keys, poser);
    poser.stand();
    motion.poses.push_back(poser.pose());
  }
  return motion;
}

void idle(double phase, Poser& poser) {
  const double sway = std::sin(kTwoPi * phase);
  const double breath = std::sin(2 * kTwoPi * phase);
  poser.pose().root_m.x += 0.018 * sway;
  poser.set("pelvis", turn(-1.5 * sway, kZ) * turn(2 * sway, kY));
  poser.trunk(1.5 - 1.2 * breath, -2.0 * sway, -2 * sway);
  poser.head(-1 + 1.0 * breath, 6 * std::sin(kTwoPi * phase + 0.8));
  for (const Side side : kSides) {
    const double near = Poser::mirror(side) * sway;
    poser.arm(side, 76 + 1.0 * breath, 2 + 1.5 * near, 16 + 2 * breath);
    poser.leg(side, 1.5 + 1.5 * near, 3 - 2.5 * near, 1.5 - 1.0 * near, -1.5 * Poser::mirror(side) * sway + 1);
  }
}

/// Angles of hip, knee and ankle over one cycle, shaped like published gait curves. The knee flexes a little under
/// load, and by 60 degrees in the swing.
void walk(double phase, Poser& poser) {
  for (const Side side : kSides) {
    const double p = phase + (side == Side::kLeft ? 0.0 : 0.5);
    const double hip = 8 + 22 * std::cos(kTwoPi * p);
    const auto bump = [&](double centre, double width) {
      const double d = std::remainder(p - centre, 1.0) / width;
      return std::exp(-d * d);
    };
    const double knee = 4 + 14 * bump(0.14, 0.09) + 56 * bump(0.72, 0.13);
    const double ankle = 6 * bump(0.42, 0.16) - 16 * bump(0.62, 0.09) - 4 * bump(0.06, 0.06);
    poser.leg(side, hip, knee, ankle, 0.5);
    poser.toes(side, 22 * bump(0.58, 0.08));
    const double swing = -std::cos(kTwoPi * p);
    poser.arm(side, 74, 2 + 22 * swing, 22 + 10 * swing);
  }
  const double twist = std::cos(kTwoPi * phase);
  poser.set("pelvis", turn(-5 * twist, kY) * turn(2.5 * std::sin(kTwoPi * phase), kZ));
  poser.trunk(3, -1.5 * std::sin(kTwoPi * phase), 9 * twist);
  poser.head(-2, -4 * twist);
  poser.pose().root_m.x += 0.020 * std::sin(kTwoPi * phase);
}

/// Goes from 0 to 1 and back: up in a quarter of the phase, a short stay, down in a quarter, centred on `centre`.
double visit(double phase, double centre) {
  const double d = std::abs(std::remainder(phase - centre, 1.0));
  const double s = std::clamp((0.25 - d) / 0.19, 0.0, 1.0);
  return s * s * s * (s * (6 * s - 15) + 10);
}

void reach(double phase, Poser& poser) {
  const double left = visit(phase, 0.25);
  const double right = visit(phase, 0.75);
  const double both = left - right;
  poser.set("pelvis", turn(-6 * both, kY));
  poser.trunk(2 + 12 * left + 5 * right, -3 * left + 4 * right, -16 * both);
  poser.head(-2 - 6 * left - 12 * right, -10 * right + 10 * left);
  poser.point_arm(Side::kLeft, {0.15, -0.05, 1.0}, left, 18 - 8 * left);
  poser.point_arm(Side::kRight, {0.35, 0.75, 0.65}, right, 18 - 6 * right);
  for (const Side side : kSides) {
    const double step = side == Side::kLeft ? left : right;
    poser.leg(side, 3 + 10 * step, 4 + 12 * step, 2 + 2 * step, 1);
  }
}

void spin(double phase, Poser& poser) {
  const double out = 0.5 - 0.5 * std::cos(2 * kTwoPi * phase);
  poser.set("pelvis", turn(360 * phase, kY));
  poser.trunk(2, 0, 6 * std::sin(kTwoPi * phase));
  poser.head(-2, 10 * std::sin(kTwoPi * phase));
  for (const Side side : kSides) {
    poser.arm(side, 40 - 34 * out, 6, 10 + 12 * (1 - out));
    const double step = std::max(0.0, std::sin(3 * kTwoPi * phase + (side == Side::kLeft ? 0 : std::numbers::pi)));
    poser.leg(side, 4 + 16 * step, 6 + 30 * step, 2 - 10 * step, 1.5);
  }
}

}  // namespace

std::vector<Motion> make_motions() {
  return {make_motion("idle", 4.0, 40, idle), make_motion("walk", 1.1, 33, walk), make_motion("reach", 4.0, 60, reach),
          make_motion("spin", 3.0, 60, spin)};
}

}  // namespace vestige::mannequin
