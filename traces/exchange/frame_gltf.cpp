#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <version.hpp>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/exchange/collider_mesh.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/files/column_file.hpp"
#include "traces/gltf/clean/append_glb.hpp"
#include "traces/gltf/clean/clean_avatar.hpp"
#include "traces/gltf/clean/glb_builder.hpp"
#include "traces/gltf/glb_container.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

using Builder = gltf::GlbBuilder;
using Json = Builder::Json;

constexpr std::uint64_t kMostGlbBytes = std::numeric_limits<std::uint32_t>::max();
constexpr int kFloat = 5126;
constexpr const char* kTooLarge = "export fewer frames: use --rate 60, or cut out a part with 'vestige trim'";

constexpr double kPoint_m = 0.01;  ///< radius with which a point is drawn
/// The scale of a node is the radius of its sphere, and a node of scale 0 is absent.
constexpr float kSmallestRadius_m = 1e-6F;

/// Returns a file that `clean_avatar_glb` made, to be continued.
Builder continued(std::span<const std::byte> glb) {
  gltf::Report unused("avatar.glb");
  const gltf::GlbChunks chunks = gltf::split_glb(glb, unused);
  Builder builder;
  builder.json = Json::parse(chunks.json);
  builder.bin.assign(chunks.bin.begin(), chunks.bin.end());
  return builder;
}

/// Returns the only scene of such a file.
Json& scene_of(Builder& builder) {
  return builder.json["scenes"][0];
}

/// A person, whose columns stand together: the origin, then three of each node.
struct GltfAvatar {
  GltfAvatar(const GltfPerson& person, const std::string& file, std::size_t first_column, std::size_t first)
      : name(person.name),
        avatar(person.avatar),
        glb(clean_avatar_glb(person.glb, file)),
        origin(first_column),
        first_float(first) {}

  std::size_t node_column(std::size_t node) const { return origin + 1 + 3 * node; }
  std::size_t columns() const { return 1 + 3 * avatar.nodes.size(); }
  std::size_t floats() const { return 3 + 10 * avatar.nodes.size(); }
  /// The numbers of a node in a row.
  const float* of_node(const std::vector<float>& row, std::size_t node) const {
    return &row[first_float + 3 + 10 * node];
  }

  std::string name;
  const Avatar& avatar;
  std::vector<std::byte> glb;  ///< the avatar without faults
  std::size_t origin;          ///< the column
  std::size_t first_float;     ///< in a row
};

/// The time's column comes first.
std::vector<GltfAvatar> avatars_of(std::span<const GltfPerson> people) {
  std::vector<GltfAvatar> avatars;
  avatars.reserve(people.size());
  std::size_t column = 1;
  std::size_t first_float = 1;
  for (const GltfPerson& person : people) {
    const std::string file = trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, avatars.size());
    const GltfAvatar& one = avatars.emplace_back(person, file, column, first_float);
    column += one.columns();
    first_float += one.floats();
  }
  return avatars;
}

std::vector<std::size_t> column_widths(const std::vector<GltfAvatar>& avatars, std::size_t colliders) {
  std::vector<std::size_t> widths = {1};
  for (const GltfAvatar& one : avatars) {
    widths.push_back(3);
    for (std::size_t i = 0; i < one.avatar.nodes.size(); ++i) widths.insert(widths.end(), {3, 4, 3});
  }
  for (std::size_t i = 0; i < colliders; ++i) widths.insert(widths.end(), {3, 3});
  return widths;
}

class FrameGltf final : public TraceExport {
 public:
  FrameGltf(const std::filesystem::path& path, Overwrite overwrite, std::span<const GltfPerson> people, ColliderIds ids)
      : file_(path, overwrite),
        path_(path),
        avatars_(avatars_of(people)),
        ids_(std::move(ids.all)),
        columns_(path, column_widths(avatars_, ids_.size())),
        varies_(columns_.columns()) {
    for (std::size_t i = 0; i < ids_.size(); ++i) place_of_[ids_[i]] = i;
    last_position_.resize(ids_.size(), glm::vec3(0));
    is_sphere_.resize(ids_.size(), false);
    for (const std::uint32_t id : ids.spheres) is_sphere_[place_of_.at(id)] = true;
  }

  void write(const TraceFrame& frame) override;
  void commit() override;
  std::vector<std::string> losses() const override;

 private:
  // The columns: time, those of each person, two of each collider.
  static constexpr std::size_t kTime = 0;
  std::size_t collider_column(std::size_t collider) const {
    return avatars_.back().origin + avatars_.back().columns() + 2 * collider;
  }
  std::size_t collider_float(std::size_t collider) const {
    return avatars_.back().first_float + avatars_.back().floats() + 6 * collider;
  }

  /// Where a person stands in the file.
  struct PlacedAvatar {
    int first_node = 0;
    std::optional<int> origin = {};
  };
  using Columns = std::vector<std::size_t>;  ///< in the order in which the GLB has them
  /// A column that moves a node.
  struct Channel {
    int node;
    std::size_t column;
    const char* path;
    const char* interpolation = "LINEAR";
  };

  void append(const glm::vec3& vector) { row_.insert(row_.end(), {vector.x, vector.y, vector.z}); }
  void append_pose(const GltfAvatar& person, const Pose& pose);
  void append_node(const Node& rest, NodeLocal node);
  float scale_of(const ColliderSample& collider, std::size_t place);
  void note_what_varies();
  PlacedAvatar place(Builder& builder, const GltfAvatar& person, const gltf::AppendedNodes& nodes) const;
  std::optional<int> add_origin_node(Builder& builder, const GltfAvatar& person, const std::vector<int>& roots) const;
  std::vector<int> add_colliders(Builder& builder) const;
  Columns add_animation(Builder& builder, const std::vector<PlacedAvatar>& placed,
                        const std::vector<int>& colliders) const;
  int begin_animation(Builder& builder) const;
  void add_channel(Builder& builder, Columns& columns, int input, const Channel& channel) const;
  void write_glb(Builder& builder, const Columns& columns);

  OutputFile file_;
  std::filesystem::path path_;
  std::vector<GltfAvatar> avatars_;
  std::vector<std::uint32_t> ids_;
  std::map<std::uint32_t, std::size_t> place_of_;
  ColumnFile columns_;
  std::vector<bool> varies_;  ///< for each column
  std::uint64_t varying_floats_ = 1;
  std::vector<float> row_;
  std::vector<float> first_row_;
  std::vector<float> last_row_;
  std::vector<glm::vec3> last_position_;
  std::vector<float> scale_;     ///< of each collider in the current frame: 0 if it is absent
  std::vector<bool> is_sphere_;  ///< for each collider; the scale of a sphere is its radius, that of a point 1
  glm::dvec3 base_m_ = glm::dvec3(0);
  std::uint64_t frames_left_out_ = 0;
  std::uint64_t poses_missing_ = 0;
  std::uint64_t non_finite_ = 0;
  std::uint64_t radii_raised_ = 0;
};

bool is_finite(const glm::vec3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

/// Corrects what glTF forbids: a rotation must have length 1, and numbers must be finite.
void FrameGltf::append_node(const Node& rest_node, NodeLocal node) {
  const auto& q = node.rotation;
  const double length = glm::length(glm::dquat(q));
  if (std::abs(length - 1) > 1e-5 && std::isfinite(length) && length > 0)
    node.rotation = glm::quat(glm::normalize(glm::dquat(q)));
  std::array numbers = {node.translation.x, node.translation.y, node.translation.z, q.x, q.y, q.z, q.w,
                        node.scale.x,       node.scale.y,       node.scale.z};
  const bool is_good = length > 0 && std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); });
  if (!is_good) {
    ++non_finite_;
    if (!last_row_.empty()) {
      std::copy_n(last_row_.begin() + static_cast<std::ptrdiff_t>(row_.size()), numbers.size(), numbers.begin());
    } else {
      const NodeLocal& rest = rest_node.rest;
      numbers = {rest.translation.x, rest.translation.y, rest.translation.z, rest.rotation.x, rest.rotation.y,
                 rest.rotation.z,    rest.rotation.w,    rest.scale.x,       rest.scale.y,    rest.scale.z};
    }
  }
  row_.insert(row_.end(), numbers.begin(), numbers.end());
}

float FrameGltf::scale_of(const ColliderSample& collider, std::size_t place) {
  if (!is_sphere_[place]) return 1;
  if (collider.radius_m < kSmallestRadius_m) ++radii_raised_;
  return std::max(collider.radius_m, kSmallestRadius_m);
}

void FrameGltf::append_pose(const GltfAvatar& person, const Pose& pose) {
  const bool is_missing = pose.nodes.empty() && !person.avatar.nodes.empty();
  if (is_missing) ++poses_missing_;
  if (is_missing && !last_row_.empty()) {
    const auto last = last_row_.begin() + static_cast<std::ptrdiff_t>(person.first_float);
    row_.insert(row_.end(), last, last + static_cast<std::ptrdiff_t>(person.floats()));
    return;
  }
  glm::vec3 origin(pose.origin_m - base_m_);
  if (!is_finite(origin)) {
    ++non_finite_;
    const std::size_t last = person.first_float;
    origin = last_row_.empty() ? glm::vec3(0) : glm::vec3(last_row_[last], last_row_[last + 1], last_row_[last + 2]);
  }
  append(origin);
  const std::vector<Node>& nodes = person.avatar.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) append_node(nodes[i], is_missing ? nodes[i].rest : pose.nodes[i]);
}

void FrameGltf::write(const TraceFrame& frame) {
  const auto time_s = static_cast<float>(static_cast<double>(frame.time_ns) / 1e9);
  if (!last_row_.empty() && !(time_s > last_row_.front())) {
    ++frames_left_out_;
    return;
  }
  if (first_row_.empty() && is_finite(glm::vec3(frame.poses.front().origin_m))) base_m_ = frame.poses.front().origin_m;
  row_.assign(1, time_s);
  for (std::size_t i = 0; i < avatars_.size(); ++i) append_pose(avatars_[i], frame.poses[i]);
  scale_.assign(ids_.size(), 0);
  for (const ColliderSample& collider : frame.colliders) {
    const auto place = place_of_.find(collider.id);
    if (place == place_of_.end()) continue;
    const glm::vec3 position(collider.position_m - base_m_);
    if (!is_finite(position)) {
      ++non_finite_;
      continue;
    }
    scale_[place->second] = scale_of(collider, place->second);
    last_position_[place->second] = position;
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    append(last_position_[i]);
    append(glm::vec3(scale_[i]));
  }
  note_what_varies();
  columns_.append(row_);
  if (columns_.rows() * varying_floats_ * sizeof(float) > kMostGlbBytes)
    throw Error(path_.string(), "would be larger than the 4 GiB that a GLB can hold", kTooLarge);
  last_row_ = row_;
}

void FrameGltf::note_what_varies() {
  if (first_row_.empty()) first_row_ = row_;
  std::size_t start = 0;
  for (std::size_t column = 0; column < varies_.size(); ++column) {
    const std::size_t width = columns_.width(column);
    if (!varies_[column] && std::memcmp(&row_[start], &first_row_[start], width * sizeof(float)) != 0) {
      varies_[column] = true;
      varying_floats_ += width;
    }
    start += width;
  }
}

/// Gives every node of a person its transform in the first frame, and puts the person into the scene.
FrameGltf::PlacedAvatar FrameGltf::place(Builder& builder, const GltfAvatar& person,
                                         const gltf::AppendedNodes& nodes) const {
  for (std::size_t i = 0; i < person.avatar.nodes.size(); ++i) {
    if (person.avatar.nodes[i].fixed_matrix) continue;
    Json& node = builder.json["nodes"][static_cast<std::size_t>(nodes.first) + i];
    const float* numbers = person.of_node(first_row_, i);
    node["translation"] = {numbers[0], numbers[1], numbers[2]};
    node["rotation"] = {numbers[3], numbers[4], numbers[5], numbers[6]};
    node["scale"] = {numbers[7], numbers[8], numbers[9]};
  }
  return {nodes.first, add_origin_node(builder, person, nodes.roots)};
}

/// Puts the roots of a person into the scene. If the person's origin moves in the world, or there are several people,
/// they stand below a node of their own. A skinned mesh follows its joints and stays at the root.
std::optional<int> FrameGltf::add_origin_node(Builder& builder, const GltfAvatar& person,
                                              const std::vector<int>& roots) const {
  Json& scene = scene_of(builder)["nodes"];
  const bool has_name = avatars_.size() > 1;
  if (!has_name && !varies_[person.origin]) {
    for (const int root : roots) scene.push_back(root);
    return {};
  }
  Json below = Json::array();
  for (const int root : roots) {
    const Json& node = builder.json["nodes"][static_cast<std::size_t>(root)];
    (node.contains("skin") && !node.contains("children") ? scene : below).push_back(root);
  }
  Json origin = {{"name", has_name ? person.name : "avatar origin"}, {"children", below}};
  if (has_name) {
    const float* first = &first_row_[person.first_float];
    origin["translation"] = {first[0], first[1], first[2]};
  }
  const int node = builder.add("nodes", std::move(origin));
  scene.push_back(node);
  return node;
}

/// Returns the nodes of the colliders.
std::vector<int> FrameGltf::add_colliders(Builder& builder) const {
  std::vector<int> nodes;
  if (ids_.empty()) return nodes;
  const int material = add_collider_material(builder);
  const bool any_sphere = std::ranges::find(is_sphere_, true) != is_sphere_.end();
  const bool any_point = std::ranges::find(is_sphere_, false) != is_sphere_.end();
  const int point_mesh = any_point ? add_sphere(builder, kPoint_m, material) : -1;
  const int sphere_mesh = any_sphere ? add_sphere(builder, 1, material) : -1;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const float* numbers = &first_row_[collider_float(i)];
    nodes.push_back(builder.add("nodes", {{"name", fmt::format("collider {}", ids_[i])},
                                          {"mesh", is_sphere_[i] ? sphere_mesh : point_mesh},
                                          {"extras", {{"radius_m", is_sphere_[i] ? 1 : 0}}},
                                          {"translation", {numbers[0], numbers[1], numbers[2]}},
                                          {"scale", {numbers[3], numbers[4], numbers[5]}}}));
    scene_of(builder)["nodes"].push_back(nodes.back());
  }
  return nodes;
}

/// Adds an animation without channels, and the view of its columns. Returns the accessor of the times.
int FrameGltf::begin_animation(Builder& builder) const {
  const std::uint64_t time_bytes = columns_.rows() * sizeof(float);
  const int view =
      builder.add("bufferViews", {{"buffer", 0}, {"byteOffset", builder.bin.size()}, {"byteLength", time_bytes}});
  const int input = builder.add("accessors", {{"bufferView", view},
                                              {"componentType", kFloat},
                                              {"count", columns_.rows()},
                                              {"type", "SCALAR"},
                                              {"min", {first_row_[kTime]}},
                                              {"max", {last_row_[kTime]}}});
  builder.json["animations"] =
      Json::array({{{"name", "trace"}, {"channels", Json::array()}, {"samplers", Json::array()}}});
  return input;
}

/// Adds a channel to the animation and its column to `columns`, unless the column never varies.
void FrameGltf::add_channel(Builder& builder, Columns& columns, int input, const Channel& channel) const {
  if (!varies_[channel.column]) return;
  const std::uint64_t offset = builder.json["bufferViews"].back()["byteLength"].get<std::uint64_t>();
  const std::size_t width = columns_.width(channel.column);
  const int output = builder.add("accessors", {{"bufferView", builder.json["bufferViews"].size() - 1},
                                               {"byteOffset", offset},
                                               {"componentType", kFloat},
                                               {"count", columns_.rows()},
                                               {"type", width == 4 ? "VEC4" : "VEC3"}});
  builder.json["bufferViews"].back()["byteLength"] = offset + columns_.rows() * width * sizeof(float);
  columns.push_back(channel.column);
  Json& animation = builder.json["animations"].back();
  animation["samplers"].push_back({{"input", input}, {"interpolation", channel.interpolation}, {"output", output}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", channel.node}, {"path", channel.path}}}});
}

/// Adds the animation: one view after all of the avatar's data, with the times, then a column for each channel.
FrameGltf::Columns FrameGltf::add_animation(Builder& builder, const std::vector<PlacedAvatar>& placed,
                                            const std::vector<int>& colliders) const {
  Columns columns = {kTime};
  const int input = begin_animation(builder);
  const auto add = [&](const Channel& channel) { add_channel(builder, columns, input, channel); };
  for (std::size_t k = 0; k < avatars_.size(); ++k) {
    const GltfAvatar& person = avatars_[k];
    if (placed[k].origin) add({*placed[k].origin, person.origin, "translation"});
    for (std::size_t i = 0; i < person.avatar.nodes.size(); ++i) {
      if (person.avatar.nodes[i].fixed_matrix) continue;
      const int node = placed[k].first_node + static_cast<int>(i);
      add({node, person.node_column(i), "translation"});
      add({node, person.node_column(i) + 1, "rotation"});
      add({node, person.node_column(i) + 2, "scale"});
    }
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    add({colliders[i], collider_column(i), "translation"});
    add({colliders[i], collider_column(i) + 1, "scale", "STEP"});
  }
  Json& json = builder.json;
  if (json["animations"][0]["channels"].empty()) {
    // If nothing moves there is no animation, because glTF forbids one without channels.
    json.erase("animations");
    json["accessors"].erase(json["accessors"].size() - 1);
    json["bufferViews"].erase(json["bufferViews"].size() - 1);
    columns.clear();
  }
  return columns;
}

void FrameGltf::commit() {
  if (columns_.rows() == 0) throw Error(path_.string(), "there is no frame to export", "");
  columns_.finish();
  Builder builder = continued(avatars_.front().glb);
  builder.json["asset"]["generator"] = fmt::format("vestige {}", kVersion);
  builder.json.erase("animations");
  std::vector<gltf::AppendedNodes> nodes = {{0, scene_of(builder)["nodes"].get<std::vector<int>>()}};
  for (auto person = avatars_.begin() + 1; person != avatars_.end(); ++person)
    nodes.push_back(gltf::append_glb(builder, continued(person->glb)));
  scene_of(builder)["nodes"] = Json::array();
  std::vector<PlacedAvatar> placed;
  for (std::size_t i = 0; i < avatars_.size(); ++i) placed.push_back(place(builder, avatars_[i], nodes[i]));
  const std::vector<int> colliders = add_colliders(builder);
  scene_of(builder)["extras"]["origin_m"] = {base_m_.x, base_m_.y, base_m_.z};
  write_glb(builder, add_animation(builder, placed, colliders));
}

void FrameGltf::write_glb(Builder& builder, const Columns& columns) {
  std::uint64_t column_bytes = 0;
  for (const std::size_t column : columns) column_bytes += columns_.rows() * columns_.width(column) * sizeof(float);
  const std::uint64_t bin_bytes = builder.bin.size() + column_bytes;
  builder.json["buffers"][0]["byteLength"] = bin_bytes;
  std::string text = builder.json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + text.size() + 8 + bin_bytes;
  if (total > kMostGlbBytes)
    throw Error(path_.string(), fmt::format("needs {} bytes, more than the 4 GiB that a GLB can hold", total),
                kTooLarge);
  const auto put = [&](std::uint64_t word) {
    const auto bits = static_cast<std::uint32_t>(word);
    file_.write(std::as_bytes(std::span(&bits, 1)));
  };
  put(0x46546C67);  // "glTF", glTF 2.0 §4.4
  put(2);
  put(total);
  put(text.size());
  put(0x4E4F534A);  // "JSON"
  file_.write(text);
  put(bin_bytes);
  put(0x004E4942);  // "BIN"
  file_.write(std::span<const std::byte>(builder.bin));
  for (const std::size_t column : columns)
    columns_.read(column, [&](std::span<const float> block) { file_.write(std::as_bytes(block)); });
  file_.commit();
}

std::vector<std::string> FrameGltf::losses() const {
  std::vector<std::string> losses;
  if (frames_left_out_ > 0)
    losses.push_back(
        fmt::format("left out {}: rounded to fp32, the time is that of the frame before (use --rate or 'vestige trim')",
                    counted(frames_left_out_, "frame")));
  if (non_finite_ > 0)
    losses.push_back(fmt::format(
        "not finite in fp32: {}; nodes and the origin keep the values of the frame before, colliders are absent",
        counted(non_finite_, "value")));
  if (poses_missing_ > 0)
    losses.push_back(
        fmt::format("{} missing: that person keeps the one of the frame before", counted(poses_missing_, "pose")));
  if (radii_raised_ > 0)
    losses.push_back(fmt::format("{} of spheres below {:g} m became that: a node of scale 0 is an absent collider",
                                 counted(radii_raised_, "radius value"), kSmallestRadius_m));
  return losses;
}

}  // namespace

std::unique_ptr<TraceExport> make_frame_gltf(const std::filesystem::path& path, Overwrite overwrite,
                                             std::span<const GltfPerson> people, ColliderIds ids) {
  return std::make_unique<FrameGltf>(path, overwrite, people, std::move(ids));
}

}  // namespace vestige
