#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "traces/base/error.hpp"
#include "traces/exchange/collider_files.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/gltf_animation.hpp"
#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_nodes.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

namespace {

using Index = std::size_t;

bool matches(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

std::set<int> joints_of(const gltf::Document& document) {
  std::set<int> joints;
  for (const tinygltf::Skin& skin : document.model.skins) joints.insert(skin.joints.begin(), skin.joints.end());
  return joints;
}

/// Returns the number at the end of a name: 17 for "collider 17".
std::optional<std::uint32_t> number_at_end(std::string_view name) {
  const std::size_t last_other = name.find_last_not_of("0123456789");
  const std::string_view digits = name.substr(last_other == std::string_view::npos ? 0 : last_other + 1);
  std::uint32_t number = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return failure == std::errc() && !digits.empty() ? std::optional(number) : std::nullopt;
}

/// The content of a file: its nodes, and one animation that plays all animations of the file together.
struct Scene {
  Avatar nodes;
  Animation animation;
  std::set<int> joints;
  std::vector<std::string> warnings;
};

Scene load(const std::filesystem::path& path) {
  Scene scene;
  const std::vector<std::byte> glb = read_avatar_glb(path);
  gltf::Report report(path.string());
  const gltf::Document document = gltf::load_document(glb, report);
  gltf::read_nodes(document, scene.nodes, report);
  gltf::MorphTargets no_skin(document, report);
  gltf::read_animations(document, no_skin, scene.nodes, report);
  scene.joints = joints_of(document);
  std::set<std::pair<int, AnimatedProperty>> animated;
  for (Animation& animation : scene.nodes.animations)
    for (AnimationChannel& channel : animation.channels) {
      if (!animated.emplace(channel.node, channel.property).second) {
        report.warn(fmt::format("nodes[{}]", channel.node), "is moved by several animations; only the first is used");
        continue;
      }
      scene.animation.duration_s = std::max(scene.animation.duration_s, double{channel.times_s.back()});
      scene.animation.channels.push_back(std::move(channel));
    }
  scene.nodes.animations.clear();
  scene.warnings = report.warnings();
  return scene;
}

std::vector<int> choose(const Scene& scene, const std::string& pattern, const std::string& name) {
  std::set<int> moving;
  for (const AnimationChannel& channel : scene.animation.channels)
    if (channel.property == AnimatedProperty::kTranslation && !scene.joints.contains(channel.node))
      moving.insert(channel.node);
  std::vector<int> chosen;
  for (int node = 0; node < static_cast<int>(scene.nodes.nodes.size()); ++node) {
    const std::string& node_name = scene.nodes.nodes[static_cast<Index>(node)].name;
    if (matches(pattern.empty() ? "[Cc]ollider*" : pattern, node_name)) chosen.push_back(node);
  }
  if (pattern.empty() && chosen.empty()) chosen.assign(moving.begin(), moving.end());
  if (!chosen.empty()) return chosen;
  std::vector<std::string> names;
  for (const Node& node : scene.nodes.nodes)
    if (!node.name.empty() && names.size() < 10) names.push_back(node.name);
  throw Error(name,
              pattern.empty()
                  ? "no node's name begins with collider, and no node other than a joint has an animated translation"
                  : fmt::format("no node's name matches '{}'", pattern),
              fmt::format("choose nodes with --nodes; the file has: {}", fmt::join(names, ", ")));
}

class GltfColliders final : public ColliderSource {
 public:
  GltfColliders(Scene scene, const std::vector<int>& chosen, const Convention& convention)
      : scene_(std::move(scene)), convention_(convention) {
    std::set<std::uint32_t> numbers;
    for (const int node : chosen)
      if (const auto number = number_at_end(scene_.nodes.nodes[static_cast<Index>(node)].name)) numbers.insert(*number);
    const bool are_numbered = numbers.size() == chosen.size();
    for (std::uint32_t i = 0; i < chosen.size(); ++i)
      colliders_.push_back(
          {are_numbered ? *number_at_end(scene_.nodes.nodes[static_cast<Index>(chosen[i])].name) : i, chosen[i]});
    std::ranges::sort(colliders_, {}, &Collider::id);
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    if (time_s > span_s().last_s) return;
    world_matrices(scene_.nodes, sample_animation(scene_.nodes, scene_.animation, time_s), matrices_);
    for (const Collider& collider : colliders_) {
      const glm::dmat4& matrix = matrices_[static_cast<Index>(collider.node)];
      const bool is_hidden =
          glm::dvec3(matrix[0]) == glm::dvec3(0) && glm::dvec3(matrix[1]) == glm::dvec3(0) && matrix[2].z == 0;
      if (!is_hidden) out.push_back({collider.id, convention_.position_m(glm::dvec3(matrix[3]))});
    }
  }

  TimeSpan span_s() const override {
    return scene_.animation.channels.empty() ? TimeSpan() : TimeSpan{0, scene_.animation.duration_s};
  }
  std::vector<std::string> warnings() const override { return scene_.warnings; }

 private:
  struct Collider {
    std::uint32_t id;
    int node;
  };
  Scene scene_;
  Convention convention_;
  std::vector<Collider> colliders_;
  std::vector<glm::dmat4> matrices_;
};

}  // namespace

std::unique_ptr<ColliderSource> read_collider_gltf(const std::filesystem::path& path, const std::string& pattern,
                                                   const Convention& convention) {
  Scene scene = load(path);
  const std::vector<int> chosen = choose(scene, pattern, path.string());
  return std::make_unique<GltfColliders>(std::move(scene), chosen, convention);
}

}  // namespace vestige
