#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "traces/colliders.hpp"
#include "traces/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kGrid = 1048576;           // 2^20 steps a metre
constexpr double kShortestPassage_s = 0.3;  // from one turn to the next
constexpr double kLongestPassage_s = 0.8;
constexpr double kBeyond = 0.35;  // a turn lies this many body sizes beyond the aim

/// One straight flight through the body.
struct Passage {
  double start_s = 0;
  double end_s = 0;
  glm::dvec3 from = glm::dvec3(0);
  glm::dvec3 to = glm::dvec3(0);
};

class Swarm final : public ColliderSource {
 public:
  Swarm(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : avatar_(avatar), animation_(animation) {
    skin_reference(avatar_, looped_pose(avatar_, animation_, 0), glm::dvec3(0), posed_);
    glm::dvec3 low = posed_.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& position : posed_) {
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
    size_ = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const glm::dvec3 centre = 0.5 * (low + high);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      Flyer flyer;
      // A generator of its own: a collider's way does not depend on how many others there are.
      flyer.random.seed(settings.seed * 0x9E3779B97F4A7C15ULL + id);
      flyer.passage.to = centre + size_ * kBeyond * 1.5 * direction(flyer.random);
      // Times before 0, so that the swarm is in full flight when the trace begins.
      flyer.passage.end_s = -uniform(flyer.random, 0, kShortestPassage_s);
      flyers_.push_back(flyer);
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    for (std::uint32_t id = 0; id < flyers_.size(); ++id) {
      Flyer& flyer = flyers_[id];
      while (flyer.passage.end_s <= time_s) flyer.passage = next_passage(flyer);
      const Passage& passage = flyer.passage;
      const double s = (time_s - passage.start_s) / (passage.end_s - passage.start_s);
      const glm::dvec3 position = passage.from + s * (passage.to - passage.from);
      out.push_back({id, glm::round(position * kGrid) / kGrid});
    }
  }

 private:
  struct Flyer {
    std::mt19937_64 random;
    Passage passage;
  };

  // The standard fixes the generator's numbers but not those of its distributions: these are our own.
  static double uniform(std::mt19937_64& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  }

  static glm::dvec3 direction(std::mt19937_64& random) {
    const double z = uniform(random, -1, 1);
    const double angle = uniform(random, 0, 2 * std::numbers::pi);
    const double around = std::sqrt(1 - z * z);
    return {around * std::cos(angle), z, around * std::sin(angle)};
  }

  Passage next_passage(Flyer& flyer) {
    Passage passage;
    passage.start_s = flyer.passage.end_s;
    passage.end_s = passage.start_s + uniform(flyer.random, kShortestPassage_s, kLongestPassage_s);
    passage.from = flyer.passage.to;
    const auto vertex = static_cast<std::size_t>(flyer.random() % avatar_.position_bind.size());
    // The aim is reached about when the passage is half over; where it then is decides the way.
    const glm::dvec3 aim = vertex_at(vertex, 0.5 * (passage.start_s + passage.end_s));
    const double distance = glm::length(aim - passage.from);
    const glm::dvec3 way = distance > 0 ? (aim - passage.from) / distance : direction(flyer.random);
    passage.to = aim + kBeyond * size_ * way;
    return passage;
  }

  glm::dvec3 vertex_at(std::size_t vertex, double time_s) {
    skin_reference(avatar_, looped_pose(avatar_, animation_, std::max(time_s, 0.0)), glm::dvec3(0), posed_);
    return posed_[vertex];
  }

  const Avatar& avatar_;
  const Animation* animation_;
  double size_ = 1;  // metres, the longest side of the avatar's box
  std::vector<glm::dvec3> posed_;
  std::vector<Flyer> flyers_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_swarm(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Swarm>(avatar, animation, settings);
}

}  // namespace vestige
