#include "traces/mannequin/skeleton.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

#include "traces/mannequin/shape.hpp"

namespace vestige::mannequin {

namespace {

std::vector<Joint> make_skeleton() {
  const Landmarks& at = landmarks();
  std::vector<Joint> joints = {{"pelvis", -1, at.pelvis},
                               {"lumbar_spine", 0, at.lumbar},
                               {"thoracic_spine", 1, at.thorax},
                               {"neck", 2, at.neck},
                               {"head", 3, at.head}};
  for (const double side : {1.0, -1.0}) {
    const std::string suffix = side > 0 ? "_left" : "_right";
    const int first = static_cast<int>(joints.size());
    const auto add = [&](const char* name, int parent, const glm::dvec3& p) {
      joints.push_back({name + suffix, parent, glm::dvec3(side * p.x, p.y, p.z)});
    };
    add("clavicle", 2, at.clavicle);
    add("upper_arm", first, at.shoulder);
    add("forearm", first + 1, at.elbow);
    add("hand", first + 2, at.wrist);
    add("thigh", 0, at.hip);
    add("shin", first + 4, at.knee);
    add("foot", first + 5, at.ankle);
    add("toes", first + 6, at.ball);
  }
  return joints;
}

/// Returns the joint whose section of the body contains `p`, a point of the left half (joints of the left side are 5 to
/// 12).
std::size_t owner(const glm::dvec3& p) {
  const Landmarks& at = landmarks();
  const auto beyond = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(p - from, glm::normalize(to - from));
  };
  enum Owner : std::size_t {
    kPelvis,
    kLumbar,
    kThorax,
    kNeck,
    kHead,
    kClavicle,
    kUpperArm,
    kForearm,
    kHand,
    kThigh,
    kShin,
    kFoot,
    kToes
  };
  if (on_arm(p)) {
    if (beyond(at.wrist, at.knuckles) > 0) return kHand;
    return beyond(at.elbow, at.wrist) > 0 ? kForearm : kUpperArm;
  }
  if (p.y > at.head.y - 0.03 + 0.25 * (at.head.z - p.z)) return kHead;
  if (p.y > at.neck.y) return kNeck;
  if (p.y > 1.36 && p.x > 0.07) return kClavicle;
  if (p.y > at.thorax.y - 0.03) return kThorax;
  if (p.y > at.lumbar.y - 0.04) return kLumbar;
  // The crease of the hip rises outwards.
  if (p.y > 0.800 + 0.75 * p.x) return kPelvis;
  if (p.y > at.knee.y) return kThigh;
  // Below the middle of the shin, the part in front is the instep.
  if (p.y > (at.knee.y + at.ankle.y) / 2) return kShin;
  if (p.y > at.ankle.y - 0.3 * std::max(0.0, p.z - at.ankle.z) && p.z < 0.05) return kShin;
  return p.z > at.ball.z ? kToes : kFoot;
}

/// Returns how far, in metres, a joint's border diffuses.
double width_m(std::size_t joint) {
  constexpr std::array<double, 13> kWidths = {0.060, 0.070, 0.070, 0.030, 0.030, 0.045, 0.042,
                                              0.028, 0.018, 0.050, 0.034, 0.024, 0.016};
  return kWidths[joint];
}

}  // namespace

const std::vector<Joint>& skeleton() {
  static const std::vector<Joint> joints = make_skeleton();
  return joints;
}

std::size_t joint(const std::string& name) {
  const auto found = std::ranges::find(skeleton(), name, &Joint::name);
  if (found == skeleton().end()) throw std::logic_error(name);
  return static_cast<std::size_t>(found - skeleton().begin());
}

JointPose rest_pose() {
  return {std::vector<glm::dquat>(skeleton().size(), glm::dquat(1, 0, 0, 0)), skeleton().front().position_m};
}

glm::dvec3 posed(const JointPose& pose, std::size_t joint, const glm::dvec3& point_m) {
  const Joint& j = skeleton()[joint];
  const glm::dvec3 turned = pose.rotations[joint] * (point_m - j.position_m);
  if (j.parent < 0) return pose.root_m + turned;
  return posed(pose, static_cast<std::size_t>(j.parent), j.position_m + turned);
}

std::vector<VertexWeights> skin_weights(const Surface& surface) {
  const auto count = static_cast<Eigen::Index>(surface.positions_m.size());
  const auto joints = static_cast<Eigen::Index>(skeleton().size());
  constexpr std::size_t kLeft = 5;
  constexpr std::size_t kPerSide = 8;
  Eigen::MatrixXd hard = Eigen::MatrixXd::Zero(count, joints);
  std::vector<double> flow_m2(surface.positions_m.size());
  for (std::size_t i = 0; i < surface.positions_m.size(); ++i) {
    glm::dvec3 p = surface.positions_m[i];
    const bool right = p.x < 0;
    p.x = std::abs(p.x);
    const std::size_t left_joint = owner(p);
    const std::size_t own = left_joint + (right && left_joint >= kLeft ? kPerSide : 0);
    hard(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(own)) = 1;
    flow_m2[i] = width_m(left_joint) * width_m(left_joint) / 2;
  }
  // (M + L) w = M w0 with M the vertices' areas and L the cotangent Laplacian times the flow.
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> area_m2(surface.positions_m.size(), 0.0);
  for (const glm::uvec3& triangle : surface.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = triangle[corner];
      const std::uint32_t b = triangle[(corner + 1) % 3];
      const std::uint32_t c = triangle[(corner + 2) % 3];
      const glm::dvec3 to_b = surface.positions_m[b] - surface.positions_m[a];
      const glm::dvec3 to_c = surface.positions_m[c] - surface.positions_m[a];
      const double doubled_area = glm::length(glm::cross(to_b, to_c));
      area_m2[a] += doubled_area / 6;
      const double cotangent = std::max(glm::dot(to_b, to_c) / doubled_area, 0.01);
      const double flow = cotangent / 2 * (flow_m2[b] + flow_m2[c]) / 2;
      const auto i = static_cast<int>(b);
      const auto j = static_cast<int>(c);
      entries.insert(entries.end(), {{i, j, -flow}, {j, i, -flow}, {i, i, flow}, {j, j, flow}});
    }
  for (std::size_t i = 0; i < area_m2.size(); ++i) {
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), area_m2[i]);
    hard.row(static_cast<Eigen::Index>(i)) *= area_m2[i];
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd soft = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(hard);

  std::vector<VertexWeights> result(surface.positions_m.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::vector<std::size_t> order(skeleton().size());
    std::iota(order.begin(), order.end(), 0);
    const auto weight = [&](std::size_t j) { return soft(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)); };
    std::ranges::stable_sort(order, std::greater(), weight);
    double sum = 0;
    const auto kept = [&](std::size_t k) { return weight(order[k]) >= 0.02 ? weight(order[k]) : 0.0; };
    for (std::size_t k = 0; k < kVertexInfluences; ++k) sum += kept(k);
    for (std::size_t k = 0; k < kVertexInfluences; ++k) {
      if (kept(k) == 0) break;
      result[i].joints[k] = static_cast<std::uint8_t>(order[k]);
      result[i].weights[k] = static_cast<float>(kept(k) / sum);
    }
  }
  return result;
}

}  // namespace vestige::mannequin
