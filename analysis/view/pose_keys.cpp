#include "analysis/view/pose_keys.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <utility>

#include "traces/scene/facing.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kAlmost = 1e-6;      // of a second: times are rounded
constexpr std::size_t kMostOut = 64;  // poses left out in a row: each pose is compared with all of them
constexpr double kMostScale = 1e3;    // one step rounds a joint's matrices of all poses: a larger one would spoil them

bool is_drawable(const glm::dvec3& root_m, const std::vector<glm::dmat4>& palette) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(root_m[axis]) < kPageReach_m)) return false;
  for (const glm::dmat4& matrix : palette)
    for (int column = 0; column < 4; ++column)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(matrix[column][axis]) < (column < 3 ? kMostScale : kPageReach_m))) return false;
  return true;
}

/// The vertex as the page skins it, relative to the root.
glm::dvec3 page_skin(const PageInfluences& influences, const glm::dvec3& position,
                     const std::vector<glm::dmat4>& palette) {
  glm::dvec3 sum(0);
  for (std::size_t k = 0; k < influences.weight.size(); ++k)
    sum += influences.weight[k] / 65535.0 * glm::dvec3(palette[influences.palette[k]] * glm::dvec4(position, 1));
  return sum;
}

std::size_t influence_count(const Influences& influences) {
  return static_cast<std::size_t>(std::ranges::count_if(influences.weight, [](float weight) { return weight > 0; }));
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

PoseKeys::PoseKeys(const Avatar& avatar) : avatar_(avatar), reach_(avatar.palette.size()) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<glm::dvec3> low(reach_.size(), glm::dvec3(kInfinity));
  std::vector<glm::dvec3> high(reach_.size(), glm::dvec3(-kInfinity));
  influences_.reserve(avatar.influences.size());
  for (std::size_t vertex = 0; vertex < avatar.influences.size(); ++vertex) {
    const Influences& influences = avatar.influences[vertex];
    influences_.push_back(page_influences(influences));
    const std::size_t count = influence_count(influences);
    if (count > influences_.back().weight.size()) cut_.push_back(vertex);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t entry = influences.palette[k];
      low[entry] = glm::min(low[entry], glm::dvec3(avatar.position_bind[vertex]));
      high[entry] = glm::max(high[entry], glm::dvec3(avatar.position_bind[vertex]));
    }
  }
  for (std::size_t entry = 0; entry < reach_.size(); ++entry)
    if (low[entry].x <= high[entry].x)
      reach_[entry] = {(low[entry] + high[entry]) / 2.0, (high[entry] - low[entry]) / 2.0};
}

std::optional<PoseKeys::Posed> PoseKeys::take(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m) const {
  if (pose.nodes.empty()) return std::nullopt;
  std::vector<glm::dmat4> world;
  world_matrices(avatar_, pose, world);
  const glm::dvec3 root = world[static_cast<std::size_t>(avatar_.root_node)][3];
  Posed posed = {at, pose.origin_m - origin_m + root, {}};
  palette_matrices(avatar_, pose, posed.palette);
  for (glm::dmat4& matrix : posed.palette) matrix[3] -= glm::dvec4(root, 0);
  if (!is_drawable(posed.root_m, posed.palette)) return std::nullopt;
  return posed;
}

void PoseKeys::add(const PageRow& at, const Pose& pose, const glm::dvec3& origin_m) {
  std::optional<Posed> taken = take(at, pose, origin_m);
  if (!taken) {
    if (!pose.nodes.empty()) ++left_out_;
    return;
  }
  Posed now = std::move(*taken);
  const PageRow& before = since_.empty() ? kept_.at : since_.back().at;
  if (rows_.empty() || now.at.index != before.index + 1 || now.at.row != before.row + 1) {
    end_stretch();
    keep(std::move(now), true);
    return;
  }
  double thinned_m = thinning_m(now);
  if (thinned_m > kTolerance_m) {
    end_stretch();
    thinned_m = 0;
  }
  since_.push_back(std::move(now));
  since_m_ = thinned_m;
  if (at.time_s - kept_.at.time_s >= 1 / kRate_hz - kAlmost || since_.size() >= kMostOut) end_stretch();
}

/// How far any vertex would move, at most, in the poses after the one kept last, if the next one kept were `end`.
double PoseKeys::thinning_m(const Posed& end) const {
  double largest_m = 0;
  const double span_s = end.at.time_s - kept_.at.time_s;
  for (const Posed& pose : since_) {
    const double part = span_s > 0 ? (pose.at.time_s - kept_.at.time_s) / span_s : 0;
    const glm::dvec3 moved_m = kept_.root_m * (1 - part) + end.root_m * part - pose.root_m;
    for (std::size_t i = 0; i < reach_.size(); ++i) {
      const glm::dmat4 change = kept_.palette[i] * (1 - part) + end.palette[i] * part - pose.palette[i];
      double error_m = glm::length(moved_m + glm::dvec3(change[3]) + glm::dmat3(change) * reach_[i].middle_m);
      for (int axis = 0; axis < 3; ++axis) error_m += glm::length(glm::dvec3(change[axis])) * reach_[i].half_m[axis];
      largest_m = std::max(largest_m, error_m);
    }
  }
  return largest_m;
}

/// Keeps the last pose since the one kept last.
void PoseKeys::end_stretch() {
  if (since_.empty()) return;
  thinned_m_ = std::max(thinned_m_, std::exchange(since_m_, 0));
  Posed last = std::move(since_.back());
  since_.clear();
  keep(std::move(last), false);
}

void PoseKeys::keep(Posed posed, bool begins) {
  if (rows_.empty()) {
    const glm::dvec3 ahead = forward_of(avatar_.facing.axis);
    for (const glm::dmat4& matrix : posed.palette) looks_ += glm::dmat3(matrix) * ahead;
  }
  rows_.push_back(posed.at.row);
  begins_.push_back(begins ? 1 : 0);
  for (int axis = 0; axis < 3; ++axis)
    roots_.push_back(static_cast<std::int32_t>(std::lround(posed.root_m[axis] / kPageUnit_m)));
  for (const glm::dmat4& matrix : posed.palette)
    for (int column = 0; column < 4; ++column)
      for (int axis = 0; axis < 3; ++axis) matrices_.push_back(static_cast<float>(matrix[column][axis]));
  if (rows_.size() == 1)
    for (std::size_t vertex = 0; vertex < influences_.size(); ++vertex) measure_cut(vertex, posed);
  else
    for (const std::size_t vertex : cut_) measure_cut(vertex, posed);
  kept_ = std::move(posed);
}

void PoseKeys::measure_cut(std::size_t vertex, const Posed& posed) {
  const glm::dvec3 drawn = page_skin(influences_[vertex], avatar_.position_bind[vertex], posed.palette);
  cut_m_ = std::max(cut_m_, glm::distance(drawn, skin_vertex(avatar_, posed.palette, vertex)));
}

double PoseKeys::facing_deg() const {
  const bool stands = std::hypot(looks_.x, looks_.z) > 0;
  const glm::dvec3 looks = stands ? looks_ : glm::dvec3(forward_of(avatar_.facing.axis));
  return glm::degrees(std::atan2(looks.x, looks.z));
}

std::vector<double> PoseKeys::finish(PageArrays& arrays, const std::string& prefix) {
  end_stretch();
  const std::size_t size = 12 * avatar_.palette.size();
  const auto step_of = [&](std::size_t i) { return 2 * (i % size / 12) + (i % 12 < 9 ? 0 : 1); };
  std::vector<double> steps(2 * avatar_.palette.size(), std::numeric_limits<double>::min());
  for (std::size_t i = 0; i < matrices_.size(); ++i)
    steps[step_of(i)] = std::max(steps[step_of(i)], std::abs(static_cast<double>(matrices_[i])) / 32767);
  std::vector<std::int16_t> stored(matrices_.size());
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i] = static_cast<std::int16_t>(std::lround(static_cast<double>(matrices_[i]) / steps[step_of(i)]));
  for (std::size_t i = 0; i < reach_.size(); ++i) {
    const glm::dvec3 farthest_m = glm::abs(reach_[i].middle_m) + reach_[i].half_m;
    const double along_m = steps[2 * i] * (farthest_m.x + farthest_m.y + farthest_m.z) + steps[2 * i + 1] + kPageUnit_m;
    rounded_m_ = std::max(rounded_m_, std::sqrt(3.0) * along_m / 2);
  }
  arrays.add(prefix + "pose_row", rows_, 1);
  arrays.add(prefix + "pose_begins", begins_);
  arrays.add(prefix + "pose_root", roots_, 3);
  arrays.add(prefix + "pose_matrix", stored, size);
  return steps;
}

}  // namespace vestige
