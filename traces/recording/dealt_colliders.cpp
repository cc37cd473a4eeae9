#include "traces/recording/dealt_colliders.hpp"

#include <algorithm>
#include <utility>

#include "traces/places/body.hpp"

namespace vestige {

namespace {

class DealtColliders final : public ColliderSource {
 public:
  explicit DealtColliders(std::vector<Hand> hands) : hands_(std::move(hands)) {}

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    for (std::size_t k = 0; k < hands_.size(); ++k) {
      const auto dealt = [&](std::uint32_t id) { return static_cast<std::uint32_t>(id * hands_.size() + k); };
      const Hand& hand = hands_[k];
      hand.colliders->sample(time_s, samples_);
      for (ColliderSample sample : samples_) {
        sample.id = dealt(sample.id);
        if (hand.stance.is_turned()) sample.position_m = on_grid(hand.stance.turned(sample.position_m));
        sample.position_m += hand.stance.position_m;
        out.push_back(sample);
      }
      for (const std::uint32_t id : hand.colliders->teleported()) teleported_.push_back(dealt(id));
    }
    std::ranges::sort(out, {}, &ColliderSample::id);
    std::ranges::sort(teleported_);
  }

  ColliderShape shape() const override {
    const bool has_spheres = std::ranges::any_of(
        hands_, [](const Hand& hand) { return hand.colliders->shape() == ColliderShape::kSpheres; });
    return has_spheres ? ColliderShape::kSpheres : ColliderShape::kPoints;
  }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all;
    for (const Hand& hand : hands_)
      for (std::string& warning : hand.colliders->warnings())
        if (std::ranges::find(all, warning) == all.end()) all.push_back(std::move(warning));
    return all;
  }

 private:
  std::vector<Hand> hands_;
  std::vector<ColliderSample> samples_;
};

class NoColliders final : public ColliderSource {
 public:
  void sample(double /*time_s*/, std::vector<ColliderSample>& out) override { out.clear(); }
};

}  // namespace

std::unique_ptr<ColliderSource> deal_colliders(std::vector<Hand> hands) {
  return std::make_unique<DealtColliders>(std::move(hands));
}

std::unique_ptr<ColliderSource> no_colliders() {
  return std::make_unique<NoColliders>();
}

}  // namespace vestige
