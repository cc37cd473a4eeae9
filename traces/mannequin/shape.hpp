#pragma once

#include <glm/vec3.hpp>

namespace vestige::mannequin {

/// Positions of the joints on the body's left side (x > 0) and in its middle, in metres: y up, z forward, feet on y =
/// 0. The rest pose is an A-pose: arms 42 degrees below the horizontal, legs slightly apart.
struct Landmarks {
  glm::dvec3 pelvis, lumbar, thorax, neck, head;
  glm::dvec3 clavicle, shoulder, elbow, wrist, knuckles;
  glm::dvec3 hip, knee, ankle, ball, toe_tip;
};
const Landmarks& landmarks();

/// Returns the distance, in metres, from the surface of the body's left half (x >= 0), negative inside. The distance is
/// never exact; near the surface it is good to a third. The shape consists of smooth unions of swept sections, round
/// cones and ellipsoids.
double signed_distance(const glm::dvec3& p);

/// Whether a point of the left half's surface belongs to the arm, which begins at the shoulder joint.
bool on_arm(const glm::dvec3& p);

}  // namespace vestige::mannequin
