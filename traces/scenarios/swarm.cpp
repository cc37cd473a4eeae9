#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "traces/places/body.hpp"
#include "traces/places/random.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kShortestPassage_s = 0.3;  // from one turn to the next
constexpr double kLongestPassage_s = 0.8;
constexpr double kBeyond = 0.35;  // a turn lies this fraction of the body's size beyond the aim

/// One straight flight through the body.
struct Passage {
  double start_s = 0;
  double end_s = 0;
  glm::dvec3 from = glm::dvec3(0);
  glm::dvec3 to = glm::dvec3(0);
};

class Swarm final : public ColliderSource {
 public:
  Swarm(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings) : body_(avatar, animation) {
    const glm::dvec3 centre = 0.5 * (body_.box_m().low + body_.box_m().high);
    flyers_.reserve(settings.count);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      // Each collider has its own generator, so its path does not depend on the number of other colliders.
      Flyer flyer{Random(settings.seed, id), {}};
      flyer.passage.to = centre + body_.size_m() * kBeyond * 1.5 * flyer.random.direction();
      // Starts before time 0, so that the swarm is in full flight at the beginning of the trace.
      flyer.passage.end_s = -flyer.random.uniform(0, kShortestPassage_s);
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
      out.push_back({id, on_grid(passage.from + s * (passage.to - passage.from))});
    }
  }

 private:
  struct Flyer {
    Random random;
    Passage passage;
  };

  Passage next_passage(Flyer& flyer) {
    Passage passage;
    passage.start_s = flyer.passage.end_s;
    passage.end_s = passage.start_s + flyer.random.uniform(kShortestPassage_s, kLongestPassage_s);
    passage.from = flyer.passage.to;
    const std::size_t vertex = flyer.random.index(body_.avatar().position_bind.size());
    // The collider reaches the aim about halfway through the passage, so the aim's position at that time determines the
    // path.
    const double aim_s = 0.5 * (passage.start_s + passage.end_s);
    const glm::dvec3 aim = skin_vertex(body_.avatar(), body_.palette(aim_s), vertex);
    const double distance = glm::length(aim - passage.from);
    const glm::dvec3 way = distance > 0 ? (aim - passage.from) / distance : flyer.random.direction();
    passage.to = aim + kBeyond * body_.size_m() * way;
    return passage;
  }

  MovingBody body_;
  std::vector<Flyer> flyers_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_swarm(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Swarm>(avatar, animation, settings);
}

}  // namespace vestige
