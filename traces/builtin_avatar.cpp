#include "traces/builtin_avatar.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <stdexcept>

#include "traces/glb_container.hpp"

namespace vestige {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kJoints = 20;
constexpr int kRings = 50;     // between the poles
constexpr int kSegments = 50;  // around
constexpr double kHeight_m = 1.75;
constexpr double kSwayDuration_s = 4;
constexpr int kSwayKeys = 121;
constexpr std::uint32_t kMapSide = 256;

/// Half-width of the body over its height, 0 (ground) to 1: feet, knees, hips, waist, chest, neck, head.
double half_width_m(double h) {
  struct Knot {
    double h;
    double width_m;
  };
  constexpr std::array<Knot, 12> kProfile = {{{0.00, 0.00},
                                              {0.02, 0.10},
                                              {0.28, 0.12},
                                              {0.48, 0.18},
                                              {0.56, 0.175},
                                              {0.63, 0.15},
                                              {0.74, 0.20},
                                              {0.81, 0.17},
                                              {0.845, 0.07},
                                              {0.87, 0.07},
                                              {0.93, 0.095},
                                              {1.00, 0.00}}};
  std::size_t i = 1;
  while (i + 1 < kProfile.size() && kProfile[i].h < h) ++i;
  const double s = std::clamp((h - kProfile[i - 1].h) / (kProfile[i].h - kProfile[i - 1].h), 0.0, 1.0);
  const double smooth = s * s * (3 - 2 * s);
  return kProfile[i - 1].width_m + smooth * (kProfile[i].width_m - kProfile[i - 1].width_m);
}

double joint_height_m(int joint) {
  return kHeight_m * (joint + 0.5) / kJoints;
}

/// The vertex and index data of the glTF buffer, attribute by attribute.
struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> texture_coordinates;
  std::vector<std::array<std::uint8_t, 4>> joints;
  std::vector<glm::vec4> weights;
  std::vector<std::uint16_t> indices;

  /// u runs once around, beginning at the back; v from the top down.
  std::uint16_t add_vertex(double u, double v) {
    const double h = 1 - v;
    const double angle = 2 * kPi * u;
    const double width_m = half_width_m(h);
    const double y = kHeight_m * h;
    positions.emplace_back(-width_m * std::sin(angle), y, -0.62 * width_m * std::cos(angle));
    texture_coordinates.emplace_back(u, v);
    add_influences(y);
    return static_cast<std::uint16_t>(positions.size() - 1);
  }

  /// A cubic B-spline over the four nearest joints: bends without a crease.
  void add_influences(double y) {
    const double place = std::clamp(y / kHeight_m * kJoints - 0.5, 0.0, kJoints - 1.0);
    const int below = static_cast<int>(place);
    const double s = place - below;
    const std::array<double, 4> spline = {(1 - s) * (1 - s) * (1 - s) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
                                          (-3 * s * s * s + 3 * s * s + 3 * s + 1) / 6, s * s * s / 6};
    std::array<std::uint8_t, 4> joint = {};
    glm::vec4 weight(0);
    for (int k = 0; k < 4; ++k) {
      joint[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::clamp(below - 1 + k, 0, kJoints - 1));
      weight[k] = static_cast<float>(spline[static_cast<std::size_t>(k)]);
    }
    // glTF wants each joint once: at the chain's ends, equal joints are merged into the first.
    for (std::size_t k = 1; k < 4; ++k) {
      for (std::size_t earlier = 0; earlier < k; ++earlier) {
        if (joint[k] != joint[earlier]) continue;
        weight[static_cast<int>(earlier)] += weight[static_cast<int>(k)];
        weight[static_cast<int>(k)] = 0;
        joint[k] = 0;
        break;
      }
    }
    joints.push_back(joint);
    weights.push_back(weight);
  }

  void add_triangle(std::uint16_t a, std::uint16_t b, std::uint16_t c) { indices.insert(indices.end(), {a, b, c}); }
};

Mesh make_mesh() {
  Mesh mesh;
  std::vector<std::array<std::uint16_t, kSegments + 1>> rings(kRings);
  for (int ring = 0; ring < kRings; ++ring)
    for (int segment = 0; segment <= kSegments; ++segment)
      rings[static_cast<std::size_t>(ring)][static_cast<std::size_t>(segment)] =
          mesh.add_vertex(static_cast<double>(segment) / kSegments, (ring + 1.0) / (kRings + 1));
  // The two vertices of the seam are one point, to the bit: sin(2 pi) is not quite sin(0).
  for (const auto& ring : rings) mesh.positions[ring[kSegments]] = mesh.positions[ring[0]];
  for (std::size_t segment = 0; segment < kSegments; ++segment) {
    // Each pole triangle has a pole of its own, in the middle of its strip of the map.
    const double u = (static_cast<double>(segment) + 0.5) / kSegments;
    const std::uint16_t top = mesh.add_vertex(u, 0);
    const std::uint16_t bottom = mesh.add_vertex(u, 1);
    mesh.positions[top] = glm::vec3(0, kHeight_m, 0);
    mesh.positions[bottom] = glm::vec3(0, 0, 0);
    mesh.add_triangle(top, rings[0][segment], rings[0][segment + 1]);
    for (std::size_t ring = 0; ring + 1 < kRings; ++ring) {
      mesh.add_triangle(rings[ring][segment], rings[ring + 1][segment], rings[ring + 1][segment + 1]);
      mesh.add_triangle(rings[ring][segment], rings[ring + 1][segment + 1], rings[ring][segment + 1]);
    }
    mesh.add_triangle(bottom, rings[kRings - 1][segment + 1], rings[kRings - 1][segment]);
  }
  return mesh;
}

/// Builds the glTF document and its one buffer side by side.
class Document {
 public:
  Document() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Vestige"}};
    json_["scene"] = 0;
  }

  /// Adds `elements` as an accessor and returns its number. `target`: 34962 vertices, 34963 indices, 0 neither.
  template <typename Element>
  std::size_t add(std::span<const Element> elements, int component_type, const char* type, int target,
                  nlohmann::json extra = nlohmann::json::object()) {
    static_assert(std::endian::native == std::endian::little, "glTF is little-endian");
    const auto bytes = std::as_bytes(elements);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    json_["bufferViews"].push_back(view);
    bin_.insert(bin_.end(), bytes.begin(), bytes.end());
    bin_.resize((bin_.size() + 3) / 4 * 4);
    extra.update({{"bufferView", json_["bufferViews"].size() - 1},
                  {"componentType", component_type},
                  {"count", elements.size()},
                  {"type", type}});
    json_["accessors"].push_back(extra);
    return json_["accessors"].size() - 1;
  }

  nlohmann::json& json() { return json_; }

  std::vector<std::byte> glb() {
    json_["buffers"] = {{{"byteLength", bin_.size()}}};
    gltf::Report report("the built-in avatar");
    return gltf::join_glb(json_.dump(), bin_, report);
  }

 private:
  nlohmann::json json_;
  std::vector<std::byte> bin_;
};

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kFloat = 5126;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;

void add_mesh(Document& document) {
  const Mesh mesh = make_mesh();
  glm::vec3 low = mesh.positions.front();
  glm::vec3 high = low;
  for (const glm::vec3& position : mesh.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const nlohmann::json bounds = {{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}};
  const nlohmann::json attributes = {
      {"POSITION", document.add<glm::vec3>(mesh.positions, kFloat, "VEC3", kVertices, bounds)},
      {"TEXCOORD_0", document.add<glm::vec2>(mesh.texture_coordinates, kFloat, "VEC2", kVertices)},
      {"JOINTS_0", document.add<std::array<std::uint8_t, 4>>(mesh.joints, kUnsignedByte, "VEC4", kVertices)},
      {"WEIGHTS_0", document.add<glm::vec4>(mesh.weights, kFloat, "VEC4", kVertices)}};
  const std::size_t indices = document.add<std::uint16_t>(mesh.indices, kUnsignedShort, "SCALAR", kIndices);
  document.json()["meshes"] = {
      {{"name", "body"}, {"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
}

/// Node 0 is the mesh, nodes 1 to 20 the chain of joints.
void add_skeleton(Document& document) {
  nlohmann::json nodes = {{{"name", "body"}, {"mesh", 0}, {"skin", 0}}};
  nlohmann::json joints = nlohmann::json::array();
  std::vector<std::array<float, 16>> inverse_binds;
  for (int joint = 0; joint < kJoints; ++joint) {
    const double below_m = joint == 0 ? 0 : joint_height_m(joint - 1);
    nlohmann::json node = {{"name", "joint_" + std::to_string(joint + 1)},
                           {"translation", {0.0, static_cast<float>(joint_height_m(joint) - below_m), 0.0}}};
    if (joint + 1 < kJoints) node["children"] = {joint + 2};
    nodes.push_back(node);
    joints.push_back(joint + 1);
    std::array<float, 16> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    matrix[13] = static_cast<float>(-joint_height_m(joint));
    inverse_binds.push_back(matrix);
  }
  document.json()["nodes"] = nodes;
  const std::size_t accessor = document.add<std::array<float, 16>>(inverse_binds, kFloat, "MAT4", 0);
  document.json()["skins"] = {{{"joints", joints}, {"inverseBindMatrices", accessor}, {"skeleton", 1}}};
  document.json()["scenes"] = {{{"nodes", {0, 1}}}};
}

/// One loop of bending to the sides, forwards and around, while the whole body wanders a little.
void add_sway(Document& document) {
  std::vector<float> times;
  times.reserve(kSwayKeys);
  for (int key = 0; key < kSwayKeys; ++key)
    times.push_back(static_cast<float>(kSwayDuration_s * key / (kSwayKeys - 1)));
  const std::size_t input =
      document.add<float>(times, kFloat, "SCALAR", 0, {{"min", {times.front()}}, {"max", {times.back()}}});
  nlohmann::json channels = nlohmann::json::array();
  nlohmann::json samplers = nlohmann::json::array();
  const auto add_channel = [&](int node, const char* path, std::size_t output) {
    samplers.push_back({{"input", input}, {"output", output}});
    channels.push_back({{"sampler", samplers.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  };
  for (int joint = 0; joint < kJoints; ++joint) {
    std::vector<glm::vec4> rotations;
    for (int key = 0; key < kSwayKeys; ++key) {
      const double phase = 2 * kPi * (key % (kSwayKeys - 1)) / (kSwayKeys - 1);
      const double delay = 0.08 * joint;  // the motion travels upwards
      const glm::dvec3 angles(0.02 * std::sin(2 * phase - delay), 0.04 * std::sin(phase - delay),
                              0.025 * std::sin(phase - 2 * delay));
      const glm::dquat rotation(angles);
      rotations.emplace_back(rotation.x, rotation.y, rotation.z, rotation.w);
    }
    add_channel(joint + 1, "rotation", document.add<glm::vec4>(rotations, kFloat, "VEC4", 0));
  }
  std::vector<glm::vec3> translations;
  for (int key = 0; key < kSwayKeys; ++key) {
    const double phase = 2 * kPi * (key % (kSwayKeys - 1)) / (kSwayKeys - 1);
    translations.emplace_back(0.15 * std::sin(phase), joint_height_m(0) + 0.02 * std::sin(2 * phase),
                              0.10 * std::sin(2 * phase));
  }
  add_channel(1, "translation", document.add<glm::vec3>(translations, kFloat, "VEC3", 0));
  document.json()["animations"] = {{{"name", "sway"}, {"channels", channels}, {"samplers", samplers}}};
}

}  // namespace

std::vector<std::byte> builtin_avatar_glb() {
  Document document;
  add_mesh(document);
  add_skeleton(document);
  add_sway(document);
  return document.glb();
}

std::vector<std::byte> builtin_actuator_map_png() {
  // The torso lies between these heights; u runs from the back over the body's right to its front and on to its left.
  constexpr double kTop_m = 1.45;
  constexpr double kBottom_m = 0.85;
  std::vector<std::uint8_t> grey(std::size_t{kMapSide} * kMapSide, 0);
  for (std::uint32_t row = 0; row < kMapSide; ++row) {
    const double y = kHeight_m * (1 - (row + 0.5) / kMapSide);
    if (y < kBottom_m || y >= kTop_m) continue;
    const int band = static_cast<int>(3 * (kTop_m - y) / (kTop_m - kBottom_m));
    for (std::uint32_t column = 0; column < kMapSide; ++column) {
      const int side = column < kMapSide / 2 ? 0 : 1;
      grey[std::size_t{row} * kMapSide + column] = static_cast<std::uint8_t>(40 * (2 * band + side + 1));
    }
  }
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = kMapSide;
  image.height = kMapSide;
  image.format = PNG_FORMAT_GRAY;
  png_alloc_size_t bytes = 0;
  std::vector<std::byte> png;
  if (png_image_write_to_memory(&image, nullptr, &bytes, 0, grey.data(), 0, nullptr) != 0) {
    png.resize(bytes);
    if (png_image_write_to_memory(&image, png.data(), &bytes, 0, grey.data(), 0, nullptr) != 0) return png;
  }
  throw std::logic_error(image.message);
}

std::string builtin_actuator_map_json() {
  nlohmann::json actuators = nlohmann::json::array();
  for (const char* height : {"upper", "middle", "lower"})
    for (const char* side : {"right", "left"})
      actuators.push_back({{"grey", 40 * (actuators.size() + 1)}, {"name", std::string(height) + " torso, " + side}});
  return nlohmann::json({{"actuators", actuators}}).dump(2) + "\n";
}

}  // namespace vestige
