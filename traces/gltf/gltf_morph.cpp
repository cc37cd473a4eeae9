#include "traces/gltf/gltf_morph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <utility>

#include "traces/gltf/gltf_accessor.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige::gltf {

namespace {

// Many targets may refer to the same data, and many nodes to the same targets. These numbers plus the file's size limit
// the time and memory that a small file can request.
constexpr std::size_t kMostRead = std::size_t{1} << 24;
constexpr std::size_t kMostTargets = std::size_t{1} << 18;

/// Returns how far the weight of target `t` departs from `rest` at most. Between the keys of a spline, each tangent
/// adds at most 4/27 of itself times the time between the keys (glTF 2.0, Appendix C.5).
double departure(const AnimationChannel& weights, std::size_t t, double rest) {
  const std::size_t keys = weights.times_s.size();
  const bool is_spline = weights.interpolation == Interpolation::kCubicSpline;
  const std::size_t count = weights.values.size() / keys / (is_spline ? 3 : 1);
  const auto value = [&](std::size_t row) { return double{weights.values[row * count + t]}; };
  double most = 0;
  double tangents = 0;
  for (std::size_t key = 0; key < keys; ++key) {
    most = std::max(most, std::abs(value(is_spline ? 3 * key + 1 : key) - rest));
    if (!is_spline || key == 0) continue;
    const double between_s = double{weights.times_s[key]} - double{weights.times_s[key - 1]};
    tangents = std::max(tangents, between_s * (std::abs(value(3 * (key - 1) + 2)) + std::abs(value(3 * key))) * 4 / 27);
  }
  return most + tangents;
}

/// Returns how a vertex's displacement turns and grows in the pose behind `palette`.
glm::dmat3 blended(const Influences& influences, const std::vector<glm::dmat4>& palette) {
  glm::dmat3 sum(0);
  for (std::size_t i = 0; i < kMaxInfluences; ++i)
    sum += double{influences.weight[i]} * glm::dmat3(palette[influences.palette[i]]);
  return sum;
}

}  // namespace

std::vector<MorphTarget> MorphTargets::at_rest(std::size_t mesh, std::size_t primitive, int node) {
  const tinygltf::Mesh& source = document_.model.meshes[mesh];
  const auto& targets = source.primitives[primitive].targets;
  const bool of_node = node >= 0 && !document_.model.nodes[static_cast<std::size_t>(node)].weights.empty();
  const std::vector<double>& weights =
      of_node ? document_.model.nodes[static_cast<std::size_t>(node)].weights : source.weights;
  const bool fits = weights.empty() || weights.size() == targets.size();
  if (!fits) {
    const std::string path = of_node ? fmt::format("nodes[{}].weights", node) : fmt::format("meshes[{}].weights", mesh);
    const bool moves = std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; });
    if (moves && !targets.empty())
      report_.fail(path, fmt::format("has {} numbers, but meshes[{}].primitives[{}] has {} morph targets",
                                     weights.size(), mesh, primitive, targets.size()));
    report_.warn(path, "does not have a number for each morph target; nothing is moved by it");
  }
  target_count_ += targets.size();
  if (target_count_ > kMostTargets + document_.data_bytes)
    report_.fail(fmt::format("meshes[{}].primitives[{}].targets", mesh, primitive),
                 fmt::format("bring the avatar to more than {} morph targets", kMostTargets + document_.data_bytes),
                 "leave out morph targets");
  std::vector<MorphTarget> result(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (const auto position = targets[t].find("POSITION"); position != targets[t].end())
      result[t].displacement = position->second;
    if (fits && !weights.empty()) result[t].weight = static_cast<float>(weights[t]);
  }
  return result;
}

void MorphTargets::bake(const std::vector<MorphTarget>& targets, const std::string& path,
                        std::span<glm::vec3> positions) {
  const auto counts = [](const MorphTarget& target) { return target.displacement && target.weight != 0; };
  if (std::none_of(targets.begin(), targets.end(), counts)) return;
  std::vector<glm::dvec3> sum(positions.begin(), positions.end());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (!counts(targets[t])) continue;
    const std::vector<glm::dvec3> moved =
        displacements(targets[t], fmt::format("{}.targets[{}].POSITION", path, t), positions.size());
    for (std::size_t i = 0; i < moved.size(); ++i) sum[i] += double{targets[t].weight} * moved[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    positions[i] = glm::vec3(sum[i]);
    if (!std::isfinite(positions[i].x) || !std::isfinite(positions[i].y) || !std::isfinite(positions[i].z))
      report_.fail(path + ".targets", fmt::format("move vertex {} beyond the range of a float", i));
  }
}

std::size_t MorphTargets::weight_count(int node) const {
  const auto shown = parts_.find(node);
  if (shown == parts_.end()) return 0;
  const std::vector<MorphedPart>& parts = shown->second;
  for (const MorphedPart& part : parts)
    if (part.targets.size() != parts.front().targets.size())
      report_.fail(part.path + ".targets",
                   fmt::format("are {}, but another primitive of the mesh has {}, and an animation moves them",
                               part.targets.size(), parts.front().targets.size()));
  return parts.front().targets.size();
}

std::optional<double> MorphTargets::reach_m(int node, const AnimationChannel& weights, const Avatar& avatar) {
  const auto departs = [&](const MorphedPart& part) {
    for (std::size_t t = 0; t < part.targets.size(); ++t)
      if (departure(weights, t, double{part.targets[t].weight}) > 0) return true;
    return false;
  };
  if (std::ranges::none_of(parts_.at(node), departs)) return {};
  std::vector<glm::dmat4> palette;
  palette_matrices(avatar, rest_pose(avatar), palette);
  std::optional<double> farthest_m;
  for (const MorphedPart& part : parts_.at(node)) {
    std::vector<glm::dmat3> turned(part.vertex_count);
    for (std::size_t i = 0; i < turned.size(); ++i)
      turned[i] = blended(avatar.influences[part.first_vertex + i], palette);
    std::vector<double> reach_m(part.vertex_count);
    for (std::size_t t = 0; t < part.targets.size(); ++t) {
      const MorphTarget& target = part.targets[t];
      const double most = departure(weights, t, double{target.weight});
      if (!target.displacement || !(most > 0)) continue;
      const std::vector<glm::dvec3> moved =
          displacements(target, fmt::format("{}.targets[{}].POSITION", part.path, t), part.vertex_count);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        if (moved[i] == glm::dvec3(0)) continue;
        reach_m[i] += most * glm::length(turned[i] * moved[i]);
        farthest_m = std::max(farthest_m.value_or(0), reach_m[i]);
      }
    }
  }
  return farthest_m;
}

std::vector<glm::dvec3> MorphTargets::displacements(const MorphTarget& target, const std::string& path,
                                                    std::size_t vertex_count) {
  read_ += vertex_count;
  const std::size_t most = kMostRead + 4 * document_.data_bytes;
  if (read_ > most)
    report_.fail(path, fmt::format("brings the morph targets to more than {} displacements", most),
                 "leave out morph targets, or animations that move them");
  const AccessorReader reader(document_, *target.displacement, position_format(document_), path, report_);
  std::vector<glm::dvec3> result;
  result.reserve(vertex_count);
  for (std::size_t i = 0; i < vertex_count; ++i)
    result.emplace_back(reader.finite(i, 0), reader.finite(i, 1), reader.finite(i, 2));
  return result;
}

}  // namespace vestige::gltf
