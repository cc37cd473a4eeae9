#include "traces/gltf/gltf_animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "traces/gltf/gltf_accessor.hpp"

namespace vestige::gltf {

namespace {

// Channels may share accessors, but each is stored separately. Ten minutes of 60 joints at 120 Hz are half of this
// limit.
constexpr std::size_t kMostNumbers = std::size_t{1} << 26;

/// Limits the memory that a small file can request: no channel stores more than four numbers for each byte of the file.
std::size_t most_numbers(const Document& document) {
  return std::min(kMostNumbers, (std::size_t{1} << 22) + 4 * document.data_bytes);
}

std::optional<AnimatedProperty> animated_property(const std::string& path) {
  if (path == "translation") return AnimatedProperty::kTranslation;
  if (path == "rotation") return AnimatedProperty::kRotation;
  if (path == "scale") return AnimatedProperty::kScale;
  return std::nullopt;
}

Interpolation interpolation(const std::string& name) {
  if (name == "STEP") return Interpolation::kStep;
  if (name == "CUBICSPLINE") return Interpolation::kCubicSpline;
  return Interpolation::kLinear;
}

/// What each key of a sampler's output holds: so many elements of this format, of so many components.
struct Output {
  Format format;
  std::size_t components = 0;
  std::size_t elements = 1;
};

constexpr unsigned kNormalized = kNormalizedInt8 | kNormalizedUint8 | kNormalizedInt16 | kNormalizedUint16;

class AnimationReader {
 public:
  AnimationReader(const Document& document, MorphTargets& morphs, const Avatar& avatar, Report& report)
      : document_(document), morphs_(morphs), avatar_(avatar), report_(report), most_numbers_(most_numbers(document)) {}

  Animation read(std::size_t index) {
    const tinygltf::Animation source = load_animation(document_, index, report_);
    Animation animation;
    animation.name = source.name;
    animation.channels.reserve(source.channels.size());
    std::set<std::pair<int, std::string>> targets;
    for (std::size_t c = 0; c < source.channels.size(); ++c) {
      const tinygltf::AnimationChannel& channel = source.channels[c];
      const std::string path = fmt::format("animations[{}].channels[{}]", index, c);
      const std::optional<AnimatedProperty> property = animated_property(channel.target_path);
      const std::size_t weights = channel.target_path == "weights" ? morphs_.weight_count(channel.target_node) : 0;
      if (!property && weights == 0) {
        if (channel.target_path == kNoNode)
          report_.warn(path + ".target", "names no node and is ignored");
        else
          report_.warn(fmt::format("{}.target.path '{}'", path, channel.target_path), "moves no node and is ignored");
        continue;
      }
      if (!targets.emplace(channel.target_node, channel.target_path).second)
        report_.fail(path + ".target", fmt::format("animates the {} of nodes[{}] a second time", channel.target_path,
                                                   channel.target_node));
      if (!property) {
        note_morph(channel.target_node,
                   read_sampler(source, index, channel, {{TINYGLTF_TYPE_SCALAR, kFloat | kNormalized}, 1, weights}),
                   fmt::format("{}: {}", report_.name(), path), animation);
        continue;
      }
      if (!document_.model.nodes[static_cast<std::size_t>(channel.target_node)].matrix.empty())
        report_.fail(path + ".target", fmt::format("animates nodes[{}], but a node with a `matrix` cannot be animated",
                                                   channel.target_node));
      animation.channels.push_back(read_channel(source, index, channel, *property));
      animation.duration_s = std::max(animation.duration_s, double{animation.channels.back().times_s.back()});
    }
    return animation;
  }

 private:
  void note_morph(int node, const AnimationChannel& weights, const std::string& where, Animation& animation) {
    const std::optional<double> reach_m = morphs_.reach_m(node, weights, avatar_);
    if (!reach_m) return;
    if (!animation.morph) animation.morph = {where, 0};
    animation.morph->reach_m = std::max(animation.morph->reach_m, *reach_m);
  }

  AnimationChannel read_channel(const tinygltf::Animation& source, std::size_t animation,
                                const tinygltf::AnimationChannel& channel, AnimatedProperty property) {
    const bool is_rotation = property == AnimatedProperty::kRotation;
    const Output output =
        is_rotation ? Output{{TINYGLTF_TYPE_VEC4, kFloat | kNormalized}, 4} : Output{{TINYGLTF_TYPE_VEC3, kFloat}, 3};
    AnimationChannel result = read_sampler(source, animation, channel, output);
    result.node = channel.target_node;
    result.property = property;
    if (is_rotation)
      check_rotations(result, fmt::format("animations[{}].samplers[{}].output", animation, channel.sampler));
    return result;
  }

  AnimationChannel read_sampler(const tinygltf::Animation& source, std::size_t animation,
                                const tinygltf::AnimationChannel& channel, const Output& output) {
    const std::string path = fmt::format("animations[{}].channels[{}]", animation, &channel - source.channels.data());
    if (static_cast<std::size_t>(channel.sampler) >= source.samplers.size())
      report_.fail(path + ".sampler", fmt::format("{} does not exist: the number of samplers is {}", channel.sampler,
                                                  source.samplers.size()));
    const tinygltf::AnimationSampler& sampler = source.samplers[static_cast<std::size_t>(channel.sampler)];
    const std::string sampler_path = fmt::format("animations[{}].samplers[{}]", animation, channel.sampler);
    AnimationChannel result;
    result.interpolation = interpolation(sampler.interpolation);
    refuse_stride(document_, sampler.input, sampler_path + ".input", report_);
    refuse_stride(document_, sampler.output, sampler_path + ".output", report_);
    const AccessorReader times(document_, sampler.input, {TINYGLTF_TYPE_SCALAR, kFloat}, sampler_path + ".input",
                               report_);
    const AccessorReader values(document_, sampler.output, output.format, sampler_path + ".output", report_);
    check_counts(times, values, result.interpolation, output.elements, sampler_path);
    numbers_ += times.count() + output.components * values.count();
    if (numbers_ > most_numbers_)
      report_.fail(path, fmt::format("brings the animations to more than {} numbers", most_numbers_),
                   "leave out animations, or resample them");
    read_times(times, sampler_path + ".input", result);
    read_values(values, output.components, result);
    if (checked_bounds_.insert(sampler.input).second) times.compare_bounds(report_);
    return result;
  }

  void check_counts(const AccessorReader& times, const AccessorReader& values, Interpolation kind, std::size_t elements,
                    const std::string& path) const {
    const bool is_spline = kind == Interpolation::kCubicSpline;
    const std::size_t needed = times.count() * elements * (is_spline ? 3 : 1);
    if (values.count() != needed)
      report_.fail(path + ".output",
                   fmt::format("has {} elements, but {} times need {}", values.count(), times.count(), needed));
    if (is_spline && times.count() < 2) report_.fail(path + ".input", "CUBICSPLINE needs at least 2 times");
  }

  void read_times(const AccessorReader& reader, const std::string& path, AnimationChannel& channel) const {
    channel.times_s.reserve(reader.count());
    for (std::size_t i = 0; i < reader.count(); ++i) {
      const float time_s = reader.finite(i, 0);
      if (time_s < 0) report_.fail(path, fmt::format("time {} is negative ({} s)", i, time_s));
      if (i > 0 && time_s <= channel.times_s.back())
        report_.fail(path, fmt::format("time {} ({} s) is not later than the time before", i, time_s));
      channel.times_s.push_back(time_s);
    }
  }

  static void read_values(const AccessorReader& reader, std::size_t components, AnimationChannel& channel) {
    channel.values.reserve(reader.count() * components);
    for (std::size_t i = 0; i < reader.count(); ++i)
      for (std::size_t c = 0; c < components; ++c) channel.values.push_back(reader.finite(i, c));
  }

  /// Checks that every key, except the tangents of a spline, is a rotation.
  void check_rotations(const AnimationChannel& channel, const std::string& path) {
    const bool is_spline = channel.interpolation == Interpolation::kCubicSpline;
    for (std::size_t key = 0; key < channel.times_s.size(); ++key) {
      const float* q = channel.values.data() + 4 * (is_spline ? 3 * key + 1 : key);
      const glm::dvec4 quaternion(q[0], q[1], q[2], q[3]);
      const double length = std::sqrt(quaternion.x * quaternion.x + quaternion.y * quaternion.y +
                                      quaternion.z * quaternion.z + quaternion.w * quaternion.w);
      if (!(length > 0)) report_.fail(path, fmt::format("key {} is zero, which is not a rotation", key));
      if (std::abs(length - 1) > 1e-2) report_.warn(path, "has rotations whose length is not 1; they are normalised");
    }
  }

  const Document& document_;
  MorphTargets& morphs_;
  const Avatar& avatar_;
  Report& report_;
  std::size_t most_numbers_ = 0;
  std::size_t numbers_ = 0;
  std::set<int> checked_bounds_;
};

}  // namespace

void read_animations(const Document& document, MorphTargets& morphs, Avatar& avatar, Report& report) {
  AnimationReader reader(document, morphs, avatar, report);
  const std::size_t count = document.json.count("animations");
  avatar.animations.reserve(count);
  for (std::size_t i = 0; i < count; ++i) avatar.animations.push_back(reader.read(i));
}

}  // namespace vestige::gltf
