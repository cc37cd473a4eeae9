// Writes the files of the built-in avatar: mannequin.glb, actuator_map.png and actuator_map.json, into the given
// folder. The files are committed, so that every build carries the same bytes.

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "traces/gltf/glb_container.hpp"
#include "traces/mannequin/animations.hpp"
#include "traces/mannequin/charts.hpp"
#include "traces/mannequin/shape.hpp"
#include "traces/mannequin/skeleton.hpp"
#include "traces/mannequin/surface.hpp"

namespace vestige::mannequin {

namespace {

constexpr double kSpacing_m = 0.0035;
constexpr std::size_t kTriangles = 5000;
constexpr std::uint32_t kMapSide = 512;

/// Builds the glTF document together with its one buffer.
class Document {
 public:
  Document() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Vestige"}};
    json_["scene"] = 0;
  }

  /// Adds `elements` as an accessor and returns its number. `target`: 34962 vertices, 34963 indices, 0 neither.
  template <typename Element>
  std::size_t add(std::span<const Element> elements, int component_type, const char* type, int target,
                  nlohmann::ordered_json extra = nlohmann::ordered_json::object()) {
    const auto bytes = std::as_bytes(elements);
    nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", bytes.size()}};
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

  nlohmann::ordered_json& json() { return json_; }

  std::vector<std::byte> glb() {
    json_["buffers"] = nlohmann::ordered_json::array({{{"byteLength", bin_.size()}}});
    const gltf::Report report("the built-in avatar");
    return gltf::join_glb(json_.dump(), bin_, report);
  }

 private:
  nlohmann::ordered_json json_;
  std::vector<std::byte> bin_;
};

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kFloat = 5126;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;

std::vector<glm::vec3> smooth_normals(const Surface& surface) {
  std::vector<glm::dvec3> sums(surface.positions_m.size(), glm::dvec3(0));
  for (const glm::uvec3& t : surface.triangles) {
    const glm::dvec3& a = surface.positions_m[t.x];
    const glm::dvec3 doubled_area = glm::cross(surface.positions_m[t.y] - a, surface.positions_m[t.z] - a);
    for (int i = 0; i < 3; ++i) sums[t[i]] += doubled_area;
  }
  std::vector<glm::vec3> normals;
  normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums) normals.emplace_back(glm::normalize(sum));
  return normals;
}

void add_mesh(const Surface& surface, const std::vector<Chart>& charts, Document& document) {
  const std::vector<VertexWeights> weights = skin_weights(surface);
  const std::vector<glm::vec3> surface_normals = smooth_normals(surface);
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> coordinates;
  std::vector<std::array<std::uint8_t, kVertexInfluences>> joints;
  std::vector<std::array<float, kVertexInfluences>> joint_weights;
  std::vector<std::uint16_t> indices;
  for (const Chart& chart : charts) {
    std::map<std::uint32_t, std::uint16_t> numbers;
    for (std::size_t i = 0; i < chart.vertices.size(); ++i) {
      const std::uint32_t v = chart.vertices[i];
      numbers[v] = static_cast<std::uint16_t>(positions.size());
      positions.emplace_back(surface.positions_m[v]);
      normals.push_back(surface_normals[v]);
      coordinates.push_back(chart.uv[i]);
      joints.push_back(weights[v].joints);
      joint_weights.push_back(weights[v].weights);
    }
    for (const std::uint32_t t : chart.triangles)
      for (int i = 0; i < 3; ++i) indices.push_back(numbers.at(surface.triangles[t][i]));
  }
  glm::vec3 low = positions.front();
  glm::vec3 high = low;
  for (const glm::vec3& position : positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const nlohmann::ordered_json bounds = {{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}};
  nlohmann::ordered_json attributes;
  attributes["POSITION"] = document.add<glm::vec3>(positions, kFloat, "VEC3", kVertices, bounds);
  attributes["NORMAL"] = document.add<glm::vec3>(normals, kFloat, "VEC3", kVertices);
  attributes["TEXCOORD_0"] = document.add<glm::vec2>(coordinates, kFloat, "VEC2", kVertices);
  attributes["JOINTS_0"] =
      document.add<std::array<std::uint8_t, kVertexInfluences>>(joints, kUnsignedByte, "VEC4", kVertices);
  attributes["WEIGHTS_0"] =
      document.add<std::array<float, kVertexInfluences>>(joint_weights, kFloat, "VEC4", kVertices);
  nlohmann::ordered_json primitive;
  primitive["attributes"] = attributes;
  primitive["indices"] = document.add<std::uint16_t>(indices, kUnsignedShort, "SCALAR", kIndices);
  primitive["material"] = 0;
  document.json()["materials"] = nlohmann::ordered_json::array(
      {{{"name", "skin"},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.70, 0.66, 0.62, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}}});
  document.json()["meshes"] = nlohmann::ordered_json::array(
      {{{"name", "mannequin"}, {"primitives", nlohmann::ordered_json::array({primitive})}}});
  fmt::print("{} triangles, {} vertices welded, {} split at UV seams\n", surface.triangles.size(),
             surface.positions_m.size(), positions.size());
}

/// Adds the nodes: node 0 is the mesh, then come the joints in the skeleton's order.
void add_skeleton(Document& document) {
  const std::vector<Joint>& joints = skeleton();
  auto nodes = nlohmann::ordered_json::array({{{"name", "mannequin"}, {"mesh", 0}, {"skin", 0}}});
  auto joint_nodes = nlohmann::ordered_json::array();
  std::vector<std::array<float, 16>> inverse_binds;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const glm::dvec3& p = joints[j].position_m;
    const glm::vec3 offset =
        p - (joints[j].parent < 0 ? glm::dvec3(0) : joints[static_cast<std::size_t>(joints[j].parent)].position_m);
    nlohmann::ordered_json node = {{"name", joints[j].name}, {"translation", {offset.x, offset.y, offset.z}}};
    for (std::size_t child = 0; child < joints.size(); ++child)
      if (joints[child].parent == static_cast<int>(j)) node["children"].push_back(child + 1);
    nodes.push_back(node);
    joint_nodes.push_back(j + 1);
    const glm::vec3 back = -p;
    inverse_binds.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, back.x, back.y, back.z, 1});
  }
  document.json()["nodes"] = nodes;
  nlohmann::ordered_json skin;
  skin["joints"] = joint_nodes;
  skin["inverseBindMatrices"] = document.add<std::array<float, 16>>(inverse_binds, kFloat, "MAT4", 0);
  skin["skeleton"] = 1;
  document.json()["skins"] = nlohmann::ordered_json::array({skin});
  document.json()["scenes"] = nlohmann::ordered_json::array({{{"nodes", {0, 1}}}});
}

void add_motion(const Motion& motion, Document& document) {
  std::vector<float> times_s;
  const double keys = static_cast<double>(motion.poses.size() - 1);
  for (std::size_t key = 0; key < motion.poses.size(); ++key)
    times_s.push_back(static_cast<float>(motion.duration_s * static_cast<double>(key) / keys));
  const std::size_t input = document.add<float>(times_s, kFloat, "SCALAR", 0,
                                                {{"min", nlohmann::ordered_json::array({times_s.front()})},
                                                 {"max", nlohmann::ordered_json::array({times_s.back()})}});
  nlohmann::ordered_json animation = {{"name", motion.name}};
  const auto add_channel = [&](std::size_t node, const char* path, std::size_t output) {
    animation["samplers"].push_back({{"input", input}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  };
  for (std::size_t j = 0; j < skeleton().size(); ++j) {
    std::vector<glm::vec4> rotations;
    for (const JointPose& pose : motion.poses) {
      glm::vec4 rotation(pose.rotations[j].x, pose.rotations[j].y, pose.rotations[j].z, pose.rotations[j].w);
      if (!rotations.empty() && glm::dot(rotation, rotations.back()) < 0) rotation = -rotation;
      rotations.push_back(rotation);
    }
    if (std::ranges::all_of(rotations, [](const glm::vec4& q) { return q == glm::vec4(0, 0, 0, 1); })) continue;
    add_channel(j + 1, "rotation", document.add<glm::vec4>(rotations, kFloat, "VEC4", 0));
  }
  std::vector<glm::vec3> translations;
  for (const JointPose& pose : motion.poses) translations.emplace_back(pose.root_m);
  add_channel(1, "translation", document.add<glm::vec3>(translations, kFloat, "VEC3", 0));
  document.json()["animations"].push_back(animation);
}

/// Six regions of the torso, after HAVE 2010, Fig. 4: three heights, right and left. 0 elsewhere.
std::uint8_t actuator_at(const glm::dvec3& p) {
  constexpr double kTop_m = 1.45;
  constexpr double kBottom_m = 0.94;
  if (p.y < kBottom_m || p.y >= kTop_m || on_arm({std::abs(p.x), p.y, p.z})) return 0;
  const int band = static_cast<int>(3 * (kTop_m - p.y) / (kTop_m - kBottom_m));
  return static_cast<std::uint8_t>(40 * (2 * band + (p.x < 0 ? 0 : 1) + 1));
}

/// Each texel gets the region of the skin point that it shows. Two rings of texels around the panels get the region of
/// their neighbours, so that rounding at a seam does not miss the region.
std::vector<std::uint8_t> draw_map(const Surface& surface, const std::vector<Chart>& charts) {
  constexpr auto kSide = static_cast<int>(kMapSide);
  std::vector<std::uint8_t> map(std::size_t{kMapSide} * kMapSide, 0);
  std::vector<bool> covered(map.size());
  const auto index = [](int x, int y) { return static_cast<std::size_t>(y) * kMapSide + static_cast<std::size_t>(x); };
  for (const Chart& chart : charts) {
    std::map<std::uint32_t, std::size_t> local;
    for (std::size_t i = 0; i < chart.vertices.size(); ++i) local[chart.vertices[i]] = i;
    for (const std::uint32_t t : chart.triangles) {
      std::array<glm::dvec2, 3> uv;
      std::array<glm::dvec3, 3> p;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = surface.triangles[t][static_cast<int>(i)];
        uv[i] = glm::dvec2(chart.uv[local.at(v)]) * double{kMapSide};
        p[i] = surface.positions_m[v];
      }
      const glm::ivec2 low = glm::floor(glm::min(uv[0], glm::min(uv[1], uv[2])));
      const glm::ivec2 high = glm::ceil(glm::max(uv[0], glm::max(uv[1], uv[2])));
      const glm::dvec2 e1 = uv[1] - uv[0];
      const glm::dvec2 e2 = uv[2] - uv[0];
      const double determinant = e1.x * e2.y - e1.y * e2.x;
      for (int y = std::max(low.y, 0); y < std::min(high.y, kSide); ++y)
        for (int x = std::max(low.x, 0); x < std::min(high.x, kSide); ++x) {
          const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - uv[0];
          const double b = (d.x * e2.y - d.y * e2.x) / determinant;
          const double c = (e1.x * d.y - e1.y * d.x) / determinant;
          if (b < 0 || c < 0 || b + c > 1) continue;
          covered[index(x, y)] = true;
          map[index(x, y)] = actuator_at((1 - b - c) * p[0] + b * p[1] + c * p[2]);
        }
    }
  }
  constexpr int kRings = 2;
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<std::uint8_t> before = map;
    for (int y = 1; y + 1 < kSide; ++y)
      for (int x = 1; x + 1 < kSide; ++x) {
        if (covered[index(x, y)] || before[index(x, y)] != 0) continue;
        for (const auto& [dx, dy] : {std::pair(0, -1), std::pair(-1, 0), std::pair(1, 0), std::pair(0, 1)})
          if (before[index(x + dx, y + dy)] != 0) map[index(x, y)] = before[index(x + dx, y + dy)];
      }
  }
  return map;
}

void write_png(const std::filesystem::path& path, const std::vector<std::uint8_t>& grey) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = kMapSide;
  image.height = kMapSide;
  image.format = PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&image, path.c_str(), 0, grey.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
}

void write(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("could not write " + path.string());
}

void author(const std::filesystem::path& folder) {
  const Surface surface = make_surface(kSpacing_m, kTriangles);
  const std::vector<Chart> charts = make_charts(surface);
  Document document;
  add_mesh(surface, charts, document);
  add_skeleton(document);
  for (const Motion& motion : make_motions()) add_motion(motion, document);
  write(folder / "mannequin.glb", document.glb());
  write_png(folder / "actuator_map.png", draw_map(surface, charts));
  auto actuators = nlohmann::ordered_json::array();
  for (const char* height : {"upper", "middle", "lower"})
    for (const char* side : {"right", "left"})
      actuators.push_back({{"grey", 40 * (actuators.size() + 1)}, {"name", fmt::format("{} torso, {}", height, side)}});
  const std::string sidecar = nlohmann::ordered_json({{"actuators", actuators}}).dump(2) + "\n";
  write(folder / "actuator_map.json", std::as_bytes(std::span(sidecar)));
}

}  // namespace

}  // namespace vestige::mannequin

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: vestige-mannequin-author FOLDER\n");
    return 2;
  }
  try {
    vestige::mannequin::author(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
