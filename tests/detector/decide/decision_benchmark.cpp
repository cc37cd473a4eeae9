// What exactness costs: a whole frame of `cpu` as it is against the same frame with a plain double test in place of the
// exact decision, taking turns; and what single decisions take. Prints a table, and JSON with provenance to the file
// named. No test, since it depends on the machine.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <fstream>
#include <glm/geometric.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/base/provenance.hpp"
#include "analysis/base/statistics.hpp"
#include "detector/broad/meshlet_candidates.hpp"
#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlet_triangles.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/broad/triangle_boxes.hpp"
#include "detector/decision.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/contact_description.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

constexpr std::uint64_t kFrames = 300;
constexpr int kRounds = 6;
constexpr int kPairs = 20000;

/// Of this thread: what else the machine does counts for nothing.
double cpu_ns() {
  timespec now = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

/// Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection (1997), in double, two-sided, for a segment.
Decision decide_plainly(const Way& way, const Corners& triangle) {
  const glm::dvec3 moved = way.end - way.start;
  const glm::dvec3 ab = triangle.b - triangle.a;
  const glm::dvec3 ac = triangle.c - triangle.a;
  const glm::dvec3 p = glm::cross(moved, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return {};
  const glm::dvec3 from_a = way.start - triangle.a;
  const double u = glm::dot(from_a, p) / determinant;
  if (u < 0 || u > 1) return {};
  const glm::dvec3 q = glm::cross(from_a, ab);
  const double v = glm::dot(moved, q) / determinant;
  if (v < 0 || u + v > 1) return {};
  const double t = glm::dot(ac, q) / determinant;
  if (t < 0 || t > 1) return {};
  return {.contact = FirstContact{static_cast<float>(t), static_cast<std::int8_t>(determinant > 0 ? 1 : -1)}};
}

/// The first contact of each collider, whoever decides.
class Winners {
 public:
  Winners(const Avatar& avatar, const ActuatorMap& map) : avatar_(avatar), map_(map) {}

  void begin(const DetectorFrame& frame) { row_.clear(frame.columns); }
  template <typename Decide>
  void offer(const DetectorFrame& frame, const Segment& segment, std::uint32_t triangle, const Corners& now,
             Decide&& decide) {
    const Way way = {glm::dvec3(segment.start), glm::dvec3(segment.end)};
    Contact& winner = row_[segment.column];
    const Decision decision = decide(way, now);
    if (!decision.contact) return;
    const float t = decision.contact->t;
    if (t > winner.t || (t == winner.t && triangle > winner.triangle)) return;
    winner = describe_contact(avatar_, map_, {triangle, way, now, *decision.contact}, frame.duration_s);
  }
  const ContactRow& row() const { return row_; }

 private:
  const Avatar& avatar_;
  const ActuatorMap& map_;
  ContactRow row_;
};

/// What `cpu` does with a frame, without skipping.
class WholeFrame {
 public:
  static constexpr const char* kSkip = "off";
  WholeFrame(const Avatar& avatar, const ActuatorMap& map) : avatar_(avatar), winners_(avatar, map) {}

  template <typename Decide>
  const ContactRow& detect(const DetectorFrame& frame, Decide&& decide) {
    winners_.begin(frame);
    skin_.skin(avatar_, frame, Method::kStatic);
    boxes_.build(avatar_, skin_, Method::kStatic);
    for (const Segment& segment : frame.segments)
      boxes_.meet(segment, [&](std::uint32_t triangle) {
        winners_.offer(frame, segment, triangle, corners_of(avatar_, skin_.now, triangle), decide);
      });
    return winners_.row();
  }

 private:
  const Avatar& avatar_;
  Winners winners_;
  SkinMotion skin_;
  TriangleBoxes boxes_;
};

/// What it does with one where it skips what no collider is near.
class SkippingFrame {
 public:
  static constexpr const char* kSkip = "on";
  SkippingFrame(const Avatar& avatar, const ActuatorMap& map)
      : winners_(avatar, map), meshlets_(avatar), candidates_(avatar, meshlets_), skin_(avatar, meshlets_) {}

  template <typename Decide>
  const ContactRow& detect(const DetectorFrame& frame, Decide&& decide) {
    winners_.begin(frame);
    candidates_.find(frame, {frame.segments, {}}, Method::kStatic);
    for (const TouchedMeshlet& touched : candidates_.touched()) {
      skin_.skin(touched.meshlet, frame.palette, corners_);
      boxes_.bound(corners_, corners_, Method::kStatic);
      const std::span<const std::uint32_t> numbers = candidates_.segments(touched);
      const std::span<const std::uint32_t> triangles = meshlets_.triangles(touched.meshlet);
      meets_.resize(numbers.size());
      boxes_.meet(frame.segments, numbers, meets_.data());
      for (std::size_t k = 0; k < numbers.size(); ++k)
        for (std::uint32_t bits = meets_[k]; bits != 0; bits &= bits - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(bits));
          if (i >= triangles.size()) break;
          winners_.offer(frame, frame.segments[numbers[k]], triangles[i], corners_.corners(i), decide);
        }
    }
    return winners_.row();
  }

 private:
  Winners winners_;
  Meshlets meshlets_;
  MeshletCandidates candidates_;
  MeshletSkin skin_;
  MeshletCorners corners_ = {};
  MeshletTriangles boxes_;
  std::vector<std::uint32_t> meets_;
};

template <typename FrameOfCpu>
nlohmann::ordered_json measure_frames(const Avatar& avatar, const ActuatorMap& map, const std::string& colliders) {
  MovingScene scene{avatar, find_animation(avatar, "walk"), nullptr, {}, 1, {}};
  scene.make_colliders = [&] { return find_scenario(colliders)->make(avatar, scene.animation, {100, 1}); };
  for (std::uint32_t id = 0; id < 100; ++id) scene.collider_ids.push_back(id);
  SceneSampler sampler(scene, 1000);
  FrameBuilder builder(avatar, scene.collider_ids);
  builder.next(sampler.next());
  std::vector<DetectorFrame> frames;
  frames.reserve(kFrames);
  for (std::uint64_t i = 0; i < kFrames; ++i) frames.push_back(builder.next(sampler.next()));

  FrameOfCpu exact(avatar, map);
  FrameOfCpu plain(avatar, map);
  std::vector<double> exact_us;
  std::vector<double> plain_us;
  std::uint64_t other_rows = 0;
  const auto timed = [](std::vector<double>& us, const auto& work) {
    const double start = cpu_ns();
    work();
    us.push_back((cpu_ns() - start) / 1e3);
  };
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const ContactRow* exact_row = nullptr;
      const ContactRow* plain_row = nullptr;
      const auto run_exact = [&] { timed(exact_us, [&] { exact_row = &exact.detect(frames[i], decide_static); }); };
      const auto run_plain = [&] { timed(plain_us, [&] { plain_row = &plain.detect(frames[i], decide_plainly); }); };
      if ((i + static_cast<std::size_t>(round)) % 2 == 0) {
        run_exact();
        run_plain();
      } else {
        run_plain();
        run_exact();
      }
      for (std::size_t column = 0; round == 0 && column < exact_row->size(); ++column)
        if ((*exact_row)[column].triangle != (*plain_row)[column].triangle) ++other_rows;
    }
  const double ratio = quantile(exact_us, 0.5) / quantile(plain_us, 0.5);
  fmt::print(
      "whole frame, static, {:<6} skip {:<3}  exact {:7.1f} us  plain double {:7.1f} us  ratio {:.3f}  "
      "other winners {}\n",
      colliders, FrameOfCpu::kSkip, quantile(exact_us, 0.5), quantile(plain_us, 0.5), ratio, other_rows);
  return {{"colliders", colliders},
          {"skip", FrameOfCpu::kSkip},
          {"count", 100},
          {"frames", exact_us.size()},
          {"exact_us_median", quantile(exact_us, 0.5)},
          {"plain_us_median", quantile(plain_us, 0.5)},
          {"ratio", ratio},
          {"other_winners", other_rows}};
}

struct Pair {
  Way way;
  Corners before;
  Corners now;
};

/// Pairs as they occur on an avatar: triangles of 3 cm, ways of some centimetres, everything fp32. The way crosses the
/// plane at weights that `weights` gives.
template <typename Weights>
std::vector<Pair> make_pairs(std::mt19937_64& random, Weights&& weights) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double scale) { return scale * glm::dvec3(unit(random), unit(random), unit(random)); };
  const auto rounded = [](const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)); };
  std::vector<Pair> pairs;
  pairs.reserve(kPairs);
  for (int i = 0; i < kPairs; ++i) {
    const glm::dvec3 place = vector(1);
    const Corners now = {rounded(place + vector(0.03)), rounded(place + vector(0.03)), rounded(place + vector(0.03))};
    const glm::dvec3 moved = vector(0.01);
    const glm::dvec2 uv = weights(random);
    const glm::dvec3 aim = now.a + uv.x * (now.b - now.a) + uv.y * (now.c - now.a);
    const glm::dvec3 direction = vector(0.03);
    pairs.push_back({{rounded(aim - direction - moved), rounded(aim + direction)},
                     {rounded(now.a - moved), rounded(now.b - moved), rounded(now.c - moved)},
                     now});
  }
  return pairs;
}

/// Nanoseconds a decision: the least of some passes.
template <typename Decide>
double decision_ns(const std::vector<Pair>& pairs, std::uint64_t& contacts, Decide&& decide) {
  double least_ns = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    contacts = 0;
    const double start = cpu_ns();
    for (const Pair& pair : pairs)
      if (decide(pair).contact) ++contacts;
    least_ns = std::min(least_ns, (cpu_ns() - start) / static_cast<double>(pairs.size()));
  }
  return least_ns;
}

nlohmann::ordered_json measure_decisions(const std::string& kind, const std::vector<Pair>& pairs) {
  nlohmann::ordered_json json = {{"pairs", kind}, {"count", pairs.size()}};
  fmt::print("a decision, {:<11}", kind);
  const auto add = [&](const std::string& name, const auto& decide) {
    std::uint64_t contacts = 0;
    const double ns = decision_ns(pairs, contacts, decide);
    json[name] = {{"ns", ns}, {"contacts", contacts}};
    fmt::print("  {} {:7.1f} ns ({:5} contacts)", name, ns, contacts);
  };
  const auto static_way = [](const Pair& pair) {
    return Way{pair.way.start + pair.now.a - pair.before.a, pair.way.end};
  };
  add("plain", [&](const Pair& pair) { return decide_plainly(static_way(pair), pair.now); });
  add("static", [&](const Pair& pair) { return decide_static(static_way(pair), pair.now); });
  add("ccd", [](const Pair& pair) { return decide_ccd(pair.way, pair.before, pair.now); });
  fmt::print("\n");
  return json;
}

void run(std::span<const std::string> arguments) {
  const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  const ActuatorMap map = parse_actuator_map(builtin_actuator_map_png(), "", "builtin");
  nlohmann::ordered_json json = provenance(arguments);
  json["frames"] = nlohmann::ordered_json::array();
  for (const char* colliders : {"swarm", "hug"}) {
    json["frames"].push_back(measure_frames<WholeFrame>(avatar, map, colliders));
    json["frames"].push_back(measure_frames<SkippingFrame>(avatar, map, colliders));
  }

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto inside = [&](std::mt19937_64& engine) {
    const double u = unit(engine);
    return glm::dvec2(u, (1 - u) * unit(engine));
  };
  const auto beside = [&](std::mt19937_64& engine) { return glm::dvec2(unit(engine), -1e-4 * unit(engine)); };
  const auto far = [&](std::mt19937_64& engine) { return glm::dvec2(1 + unit(engine), 1 + unit(engine)); };
  const auto on_edge = [&](std::mt19937_64& engine) { return glm::dvec2(unit(engine), 0); };
  json["decisions"] = {measure_decisions("hits", make_pairs(random, inside)),
                       measure_decisions("near misses", make_pairs(random, beside)),
                       measure_decisions("far misses", make_pairs(random, far)),
                       measure_decisions("edge-aimed", make_pairs(random, on_edge))};
  if (arguments.size() > 1) std::ofstream(arguments[1]) << json.dump(2) << "\n";
}

}  // namespace
}  // namespace vestige

int main(int argc, char** argv) {
  vestige::run(std::vector<std::string>(argv, argv + argc));
}
