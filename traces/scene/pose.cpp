#include "traces/scene/pose.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "traces/scene/avatar.hpp"

namespace vestige {

namespace {

/// The place of a time among the keys: between `key` and `key + 1`, at `fraction` of the interval. A time outside the
/// keys lies on the first or last key.
struct KeyPosition {
  std::size_t key = 0;
  double fraction = 0;
  double span_s = 0;
};

KeyPosition find_key(const std::vector<float>& times_s, double time_s) {
  if (!(time_s > double{times_s.front()})) return {};
  if (time_s >= double{times_s.back()}) return {times_s.size() - 1, 0, 0};
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s,
                                      [](double time, float key_s) { return time < double{key_s}; });
  const auto key = static_cast<std::size_t>(std::distance(times_s.begin(), after)) - 1;
  const double span_s = double{times_s[key + 1]} - double{times_s[key]};
  return {key, (time_s - double{times_s[key]}) / span_s, span_s};
}

template <typename Value>
Value load(const float* numbers);

template <>
glm::dvec3 load<glm::dvec3>(const float* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

template <>
glm::dquat load<glm::dquat>(const float* numbers) {
  return {numbers[3], numbers[0], numbers[1], numbers[2]};
}

/// A spline between opposite rotations can pass through zero, which has no direction. In that case returns `fallback`.
glm::dquat normalized(const glm::dquat& q, const glm::dquat& fallback) {
  const double length = glm::length(q);
  return length > 0 ? q / length : fallback;
}

glm::dvec3 finish(const glm::dvec3& value, const glm::dvec3&) {
  return value;
}
glm::dquat finish(const glm::dquat& value, const glm::dquat& fallback) {
  return normalized(value, glm::normalize(fallback));
}

glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double t) {
  return (1 - t) * a + t * b;
}

/// Spherical linear interpolation along the shorter arc (glTF 2.0, Appendix C.4).
glm::dquat between(const glm::dquat& from, const glm::dquat& to, double t) {
  const glm::dquat a = glm::normalize(from);
  glm::dquat b = glm::normalize(to);
  double cosine = glm::dot(a, b);
  if (cosine < 0) {
    b = -b;
    cosine = -cosine;
  }
  // Above this cosine, the sine of the angle equals the angle to the last bit of a double.
  constexpr double kNearlyOne = 1 - 1e-15;
  if (cosine > kNearlyOne) return (1 - t) * a + t * b;
  const double angle = std::acos(cosine);
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

/// The cubic Hermite spline of glTF 2.0, Appendix C.5. `keys` points to the in-tangent, value and out-tangent of the
/// key before the time; each of them has `stride` floats.
template <typename Value>
Value spline(const float* keys, std::size_t stride, const KeyPosition& at) {
  const double t = at.fraction;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const auto value_before = load<Value>(keys + stride);
  const auto tangent_before = load<Value>(keys + 2 * stride);
  const auto tangent_after = load<Value>(keys + 3 * stride);
  const auto value_after = load<Value>(keys + 4 * stride);
  return (2 * t3 - 3 * t2 + 1) * value_before + (at.span_s * (t3 - 2 * t2 + t)) * tangent_before +
         (-2 * t3 + 3 * t2) * value_after + (at.span_s * (t3 - t2)) * tangent_after;
}

template <typename Value>
Value sample(const AnimationChannel& channel, double time_s) {
  constexpr std::size_t kStride = std::is_same_v<Value, glm::dquat> ? 4 : 3;
  const KeyPosition at = find_key(channel.times_s, time_s);
  const bool is_spline = channel.interpolation == Interpolation::kCubicSpline;
  const float* keys = channel.values.data() + at.key * kStride * (is_spline ? 3 : 1);
  const auto value = load<Value>(is_spline ? keys + kStride : keys);
  if (at.fraction == 0 || channel.interpolation == Interpolation::kStep) return finish(value, value);
  if (is_spline) return finish(spline<Value>(keys, kStride, at), value);
  return finish(between(value, load<Value>(keys + kStride), at.fraction), value);
}

glm::dmat4 local_matrix(const NodeLocal& local) {
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(local.rotation)));
  const glm::dvec3 scale(local.scale);
  return {glm::dvec4(rotation[0] * scale.x, 0), glm::dvec4(rotation[1] * scale.y, 0),
          glm::dvec4(rotation[2] * scale.z, 0), glm::dvec4(glm::dvec3(local.translation), 1)};
}

using Pair [[gnu::vector_size(16)]] = double;

Pair pair_of(const glm::dvec4& column, int first) {
  Pair pair;
  std::memcpy(&pair, &column[first], sizeof(pair));
  return pair;
}

/// Computes a * b as glm does, to the last bit, two rows at once.
void multiply(const glm::dmat4& a, const glm::dmat4& b, glm::dmat4& out) {
  for (int row = 0; row < 4; row += 2) {
    const Pair x = pair_of(a[0], row);
    const Pair y = pair_of(a[1], row);
    const Pair z = pair_of(a[2], row);
    const Pair w = pair_of(a[3], row);
    for (int column = 0; column < 4; ++column) {
      const glm::dvec4& by = b[column];
      const Pair sum = x * by.x + y * by.y + z * by.z + w * by.w;
      std::memcpy(&out[column][row], &sum, sizeof(sum));
    }
  }
}

}  // namespace

Pose rest_pose(const Avatar& avatar) {
  Pose pose;
  pose.nodes.reserve(avatar.nodes.size());
  for (const Node& node : avatar.nodes) pose.nodes.push_back(node.rest);
  return pose;
}

Pose sample_animation(const Avatar& avatar, const Animation& animation, double time_s) {
  Pose pose = rest_pose(avatar);
  for (const AnimationChannel& channel : animation.channels) {
    NodeLocal& local = pose.nodes[static_cast<std::size_t>(channel.node)];
    switch (channel.property) {
      case AnimatedProperty::kTranslation:
        local.translation = glm::vec3(sample<glm::dvec3>(channel, time_s));
        break;
      case AnimatedProperty::kRotation:
        local.rotation = glm::quat(sample<glm::dquat>(channel, time_s));
        break;
      case AnimatedProperty::kScale:
        local.scale = glm::vec3(sample<glm::dvec3>(channel, time_s));
        break;
    }
  }
  return pose;
}

Pose looped_pose(const Avatar& avatar, const Animation* animation, double time_s) {
  if (animation == nullptr) return rest_pose(avatar);
  const double duration_s = animation->duration_s;
  return sample_animation(avatar, *animation, duration_s > 0 ? std::fmod(time_s, duration_s) : 0.0);
}

void world_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out) {
  out.resize(avatar.nodes.size());
  for (const int index : avatar.node_order) {
    const auto i = static_cast<std::size_t>(index);
    const Node& node = avatar.nodes[i];
    const glm::dmat4 local = node.fixed_matrix ? *node.fixed_matrix : local_matrix(pose.nodes[i]);
    if (node.parent < 0) {
      out[i] = local;
    } else {
      multiply(out[static_cast<std::size_t>(node.parent)], local, out[i]);
    }
  }
}

}  // namespace vestige
