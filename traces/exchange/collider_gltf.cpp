#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <set>

#include "traces/base/error.hpp"
#include "traces/exchange/collider_files.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/gltf_animation.hpp"
#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_nodes.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/radius.hpp"

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
  std::vector<double> radii;  ///< of each node, at scale 1
  std::vector<std::string> warnings;
  std::string name;  ///< of the file
};

constexpr std::string_view kRadiusRemedy = "a radius is a number of metres from 0 to 10; --radius M gives another one";

/// Returns the radius that the node's `extras.radius_m` says; 0 if it says none.
double radius_in_extras(const gltf::Document& document, Index node, const gltf::Report& report) {
  const nlohmann::json radius = document.json.extra("nodes", node, "radius_m");
  if (radius.is_null()) return 0;
  const std::string path = fmt::format("nodes[{}].extras.radius_m", node);
  if (!radius.is_number()) report.fail(path, "is not a number", kRadiusRemedy);
  const auto radius_m = radius.get<double>();
  if (const std::string_view fault = radius_fault(radius_m); !fault.empty()) report.fail(path, fault, kRadiusRemedy);
  return radius_m;
}

/// Returns half of the longest side of the box around the node's mesh; 0 if it has none.
double radius_of_mesh(const gltf::Document& document, Index node, const gltf::Report& report) {
  const int mesh = document.model.nodes[node].mesh;
  if (mesh < 0) return 0;
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (const tinygltf::Primitive& primitive : document.model.meshes[static_cast<Index>(mesh)].primitives) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) continue;
    const gltf::Accessor& accessor = document.accessors[static_cast<Index>(position->second)];
    if (!accessor.min || !accessor.max || accessor.normalized)
      report.fail(fmt::format("meshes[{}]", mesh), "does not tell its size by the bounds of its positions",
                  "give the radius as a number: --radius M");
    low = glm::min(low, glm::dvec3((*accessor.min)[0], (*accessor.min)[1], (*accessor.min)[2]));
    high = glm::max(high, glm::dvec3((*accessor.max)[0], (*accessor.max)[1], (*accessor.max)[2]));
  }
  const glm::dvec3 size = high - low;
  return std::max({0.0, 0.5 * size.x, 0.5 * size.y, 0.5 * size.z});
}

Scene load(const std::filesystem::path& path, GltfRadius radius) {
  Scene scene;
  scene.name = path.string();
  const std::vector<std::byte> glb = read_avatar_glb(path);
  gltf::Report report(path.string());
  const gltf::Document document = gltf::load_document(glb, report);
  gltf::read_nodes(document, scene.nodes, report);
  gltf::MorphTargets no_skin(document, report);
  gltf::read_animations(document, no_skin, scene.nodes, report);
  scene.joints = joints_of(document);
  scene.radii.resize(scene.nodes.nodes.size());
  for (Index node = 0; node < scene.radii.size() && radius != GltfRadius::kNone; ++node)
    scene.radii[node] =
        radius == GltfRadius::kMesh ? radius_of_mesh(document, node, report) : radius_in_extras(document, node, report);
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

std::vector<int> choose(const Scene& scene, const std::string& pattern) {
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
  throw Error(scene.name,
              pattern.empty()
                  ? "no node's name begins with collider, and no node other than a joint has an animated translation"
                  : fmt::format("no node's name matches '{}'", pattern),
              fmt::format("choose nodes with --nodes; the file has: {}", fmt::join(names, ", ")));
}

class GltfColliders final : public ColliderSource {
 public:
  GltfColliders(Scene scene, const std::vector<int>& chosen, const Convention& convention, GltfRadius radius)
      : scene_(std::move(scene)), convention_(convention) {
    // `radius_m` says its unit; a mesh has that of the file.
    if (radius == GltfRadius::kMesh)
      for (double& at_scale_1 : scene_.radii) at_scale_1 *= convention.metres_per_unit;
    has_radii_ = std::ranges::any_of(chosen, [&](int node) { return scene_.radii[static_cast<Index>(node)] > 0; });
    std::set<std::uint32_t> numbers;
    for (const int node : chosen)
      if (const auto number = number_at_end(scene_.nodes.nodes[static_cast<Index>(node)].name)) numbers.insert(*number);
    const bool are_numbered = numbers.size() == chosen.size();
    for (std::uint32_t i = 0; i < chosen.size(); ++i)
      colliders_.push_back(
          {are_numbered ? *number_at_end(scene_.nodes.nodes[static_cast<Index>(chosen[i])].name) : i, chosen[i]});
    std::ranges::sort(colliders_, {}, &Collider::id);
    for (const AnimationChannel& channel : scene_.animation.channels)
      keys_s_.insert(keys_s_.end(), channel.times_s.begin(), channel.times_s.end());
    std::ranges::sort(keys_s_);
    keys_s_.erase(std::unique(keys_s_.begin(), keys_s_.end()), keys_s_.end());
    if (has_radii_) check_radii();
    if (radius == GltfRadius::kMesh) count_meshes(chosen);
  }

  void sample(double exact_s, std::vector<ColliderSample>& out) override {
    out.clear();
    const double time_s = key_at(exact_s);
    if (time_s > span_s().last_s) return;
    world_matrices(scene_.nodes, sample_animation(scene_.nodes, scene_.animation, time_s), matrices_);
    for (const Collider& collider : colliders_) {
      const glm::dmat4& matrix = matrices_[static_cast<Index>(collider.node)];
      const bool is_hidden =
          glm::dvec3(matrix[0]) == glm::dvec3(0) && glm::dvec3(matrix[1]) == glm::dvec3(0) && matrix[2].z == 0;
      if (!is_hidden)
        out.push_back({collider.id, convention_.position_m(glm::dvec3(matrix[3])), radius_of(collider, exact_s)});
    }
  }

  ColliderShape shape() const override { return has_radii_ ? ColliderShape::kSpheres : ColliderShape::kPoints; }

  std::optional<std::uint32_t> largest_id() const override { return colliders_.back().id; }

  TimeSpan span_s() const override {
    return scene_.animation.channels.empty() ? TimeSpan() : TimeSpan{0, scene_.animation.duration_s};
  }
  std::vector<std::string> warnings() const override { return scene_.warnings; }

 private:
  struct Collider {
    std::uint32_t id;
    int node;
  };

  /// Returns the time of a key if it rounds to that in fp32, as keys have it: on them, nothing is interpolated.
  double key_at(double exact_s) const {
    const auto rounded_s = static_cast<float>(exact_s);
    return std::ranges::binary_search(keys_s_, rounded_s) ? double{rounded_s} : exact_s;
  }

  /// Returns the radius in the scene of `matrices_`. Where axes differ in their scale, the longest counts.
  float radius_of(const Collider& collider, double time_s) const {
    const glm::dmat4& matrix = matrices_[static_cast<Index>(collider.node)];
    const double scale = std::max(
        {glm::length(glm::dvec3(matrix[0])), glm::length(glm::dvec3(matrix[1])), glm::length(glm::dvec3(matrix[2]))});
    const double radius_m = scale * scene_.radii[static_cast<Index>(collider.node)];
    if (const std::string_view fault = radius_fault(radius_m); !fault.empty())
      throw Error(scene_.name,
                  fmt::format("at {} s, the radius of node '{}', {:g} m, {}", time_s,
                              scene_.nodes.nodes[static_cast<Index>(collider.node)].name, radius_m, fault),
                  "check the node's scale, or give --radius M");
    return static_cast<float>(radius_m);
  }

  /// Looks at the radii at all keys, before any of them is recorded.
  void check_radii() {
    std::vector<ColliderSample> unused;
    if (keys_s_.empty()) sample(0, unused);
    for (const float key_s : keys_s_) sample(double{key_s}, unused);
  }

  void count_meshes(const std::vector<int>& chosen) {
    const auto without =
        std::ranges::count_if(chosen, [&](int node) { return scene_.radii[static_cast<Index>(node)] == 0; });
    if (without == std::ssize(chosen))
      throw Error(scene_.name, "none of the chosen nodes has a mesh, so --radius mesh tells no radius",
                  "give the radius as a number of metres: --radius M");
    if (without > 0)
      scene_.warnings.push_back(
          fmt::format("{} of {} chosen nodes have no mesh, so they are points", without, chosen.size()));
  }

  Scene scene_;
  Convention convention_;
  std::vector<Collider> colliders_;
  std::vector<glm::dmat4> matrices_;
  std::vector<float> keys_s_;  ///< the times of all keys, ascending
  bool has_radii_ = false;
};

}  // namespace

std::unique_ptr<ColliderSource> read_collider_gltf(const std::filesystem::path& path, const std::string& pattern,
                                                   const Convention& convention, GltfRadius radius) {
  Scene scene = load(path, radius);
  const std::vector<int> chosen = choose(scene, pattern);
  return std::make_unique<GltfColliders>(std::move(scene), chosen, convention, radius);
}

}  // namespace vestige
