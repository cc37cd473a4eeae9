#include "analysis/view/pose_keys.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "detector/skinning.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kAlmost = 1e-6;  // of a second: times are rounded
/// The most that a joint turns between kept poses, in radians, about. Half a metre from the joint, the straight way
/// between them is then 0.6 mm off the arc: 0.5 m * 0.1^2 / 8.
constexpr double kMostTurn = 0.1;
constexpr std::size_t kMeasuredAtFirst = 60;
constexpr std::size_t kMeasuredLater = 60;  // every so many intervals

bool is_drawable(const glm::dvec3& root_m, const std::vector<glm::dmat4>& palette) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(root_m[axis]) < kPageReach_m)) return false;
  for (const glm::dmat4& matrix : palette)
    for (int column = 0; column < 4; ++column)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(matrix[column][axis]) < kPageReach_m)) return false;
  return true;
}

/// How far any joint has turned, in radians, about: the largest change in a matrix, in parts of its largest number.
double turn_between(const std::vector<glm::dmat4>& a, const std::vector<glm::dmat4>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double change = 0;
    double size = std::numeric_limits<double>::min();
    for (int column = 0; column < 3; ++column)
      for (int axis = 0; axis < 3; ++axis) {
        change = std::max(change, std::abs(a[i][column][axis] - b[i][column][axis]));
        size = std::max(size, std::abs(a[i][column][axis]));
      }
    most = std::max(most, change / size);
  }
  return most;
}

/// The vertex as the page skins it, relative to the root.
glm::dvec3 page_skin(const PageInfluences& influences, const glm::dvec3& position,
                     const std::vector<glm::dmat4>& palette) {
  glm::dvec3 sum(0);
  for (std::size_t k = 0; k < influences.weight.size(); ++k)
    sum += influences.weight[k] / 65535.0 * glm::dvec3(palette[influences.palette[k]] * glm::dvec4(position, 1));
  return sum;
}

}  // namespace

PageInfluences page_influences(const Influences& influences) {
  std::array<std::size_t, kMaxInfluences> order = {};
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return influences.weight[a] > influences.weight[b]; });
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(influences.weight[order[k]]);
  PageInfluences page;
  if (!(sum > 0)) return page;
  long left = 65535;
  for (std::size_t k = 4; k-- > 0;) {  // the largest takes what rounding leaves
    const long share = k == 0 ? left : std::lround(65535 * static_cast<double>(influences.weight[order[k]]) / sum);
    page.palette[k] = influences.palette[order[k]];
    page.weight[k] = static_cast<std::uint16_t>(share);
    left -= share;
  }
  return page;
}

PoseKeys::PoseKeys(const Avatar& avatar) : avatar_(avatar) {
  influences_.reserve(avatar.influences.size());
  for (const Influences& influences : avatar.influences) influences_.push_back(page_influences(influences));
}

bool PoseKeys::take(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m) {
  if (pose.nodes.empty()) return false;
  std::vector<glm::dmat4> world;
  world_matrices(avatar_, pose, world);
  const glm::dvec3 root = world[static_cast<std::size_t>(avatar_.root_node)][3];
  now_.at = at;
  now_.root_m = pose.origin_m + root - origin_m;
  palette_matrices(avatar_, pose, now_.palette);
  for (glm::dmat4& matrix : now_.palette) matrix[3] -= glm::dvec4(root, 0);
  return is_drawable(now_.root_m, now_.palette);
}

void PoseKeys::add(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m) {
  if (!take(at, pose, origin_m)) return;
  const double passed_s = at.time_s - kept_.at.time_s;
  const std::uint64_t before = last_ ? last_->at.index : kept_.at.index;
  const bool is_first = rows_.empty();
  const bool after_gap = !is_first && at.index != before + 1;
  const double share =  // of what may lie between two kept poses
      is_first ? 1 : std::max((passed_s + kAlmost) * kRate_hz, turn_between(kept_.palette, now_.palette) / kMostTurn);
  if (after_gap && last_) keep(*std::exchange(last_, {}));
  if (is_first || after_gap || share >= 1) {
    if (!is_first && !after_gap && middle_) measure(kept_, now_);
    keep(now_);
    last_.reset();
  } else {
    if (!middle_ && share >= 0.5) middle_ = now_;
    last_ = now_;
  }
}

void PoseKeys::keep(const Posed& posed) {
  rows_.push_back(posed.at.row);
  for (int axis = 0; axis < 3; ++axis)
    roots_.push_back(static_cast<std::int32_t>(std::lround(posed.root_m[axis] / kPageUnit_m)));
  for (const glm::dmat4& matrix : posed.palette)
    for (int column = 0; column < 4; ++column)
      for (int axis = 0; axis < 3; ++axis) matrices_.push_back(static_cast<float>(matrix[column][axis]));
  kept_ = posed;
  middle_.reset();
}

void PoseKeys::measure(const Posed& before, const Posed& after) {
  if (++intervals_ > kMeasuredAtFirst && intervals_ % kMeasuredLater != 0) return;
  const double part = (middle_->at.time_s - before.at.time_s) / (after.at.time_s - before.at.time_s);
  std::vector<glm::dmat4> between(before.palette.size());
  for (std::size_t i = 0; i < between.size(); ++i)
    between[i] = before.palette[i] * (1 - part) + after.palette[i] * part;
  const glm::dvec3 moved_m = before.root_m * (1 - part) + after.root_m * part - middle_->root_m;
  for (std::size_t vertex = 0; vertex < influences_.size(); ++vertex) {
    const glm::dvec3 drawn = moved_m + page_skin(influences_[vertex], avatar_.position_bind[vertex], between);
    const double error_m = glm::distance(drawn, skin_vertex(avatar_, middle_->palette, vertex));
    largest_error_m_ = std::max(largest_error_m_, error_m);
  }
}

/// How far the steps of the numbers can move a vertex.
double PoseKeys::rounding_m(const std::array<double, 2>& steps) const {
  const glm::dvec3 extent_m = bind_extent_m(avatar_);
  return std::sqrt(3.0) * (steps[0] * (extent_m.x + extent_m.y + extent_m.z) + steps[1] + kPageUnit_m) / 2;
}

std::array<double, 2> PoseKeys::finish(PageArrays& arrays, const std::string& prefix) {
  if (last_) keep(*std::exchange(last_, {}));
  const std::size_t size = 12 * avatar_.palette.size();
  const auto step_of = [&](std::size_t i) { return static_cast<std::size_t>(i % 12 < 9 ? 0 : 1); };
  std::array<double, 2> steps = {std::numeric_limits<double>::min(), std::numeric_limits<double>::min()};
  for (std::size_t i = 0; i < matrices_.size(); ++i)
    steps[step_of(i)] = std::max(steps[step_of(i)], std::abs(static_cast<double>(matrices_[i])) / 32767);
  std::vector<std::int16_t> stored(matrices_.size());
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i] = static_cast<std::int16_t>(std::lround(static_cast<double>(matrices_[i]) / steps[step_of(i)]));
  arrays.add(prefix + "pose_row", rows_, 1);
  arrays.add(prefix + "pose_root", roots_, 3);
  arrays.add(prefix + "pose_matrix", stored, size);
  largest_error_m_ += rounding_m(steps);
  return steps;
}

}  // namespace vestige
