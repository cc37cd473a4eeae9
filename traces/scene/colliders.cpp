#include "traces/scene/colliders.hpp"

#include <utility>

namespace vestige {

namespace {

class SizedColliders final : public ColliderSource {
 public:
  SizedColliders(std::unique_ptr<ColliderSource> source, float radius_m)
      : source_(std::move(source)), radius_m_(radius_m) {}

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    source_->sample(time_s, out);
    for (ColliderSample& collider : out) collider.radius_m = radius_m_;
    teleported_ = source_->teleported();
  }
  ColliderShape shape() const override { return radius_m_ > 0 ? ColliderShape::kSpheres : ColliderShape::kPoints; }
  Owners owners() const override { return source_->owners(); }
  std::optional<std::uint32_t> largest_id() const override { return source_->largest_id(); }
  TimeSpan span_s() const override { return source_->span_s(); }
  double median_step_s() const override { return source_->median_step_s(); }
  std::vector<std::string> warnings() const override { return source_->warnings(); }

 private:
  std::unique_ptr<ColliderSource> source_;
  float radius_m_;
};

}  // namespace

std::unique_ptr<ColliderSource> with_radius(std::unique_ptr<ColliderSource> source, float radius_m) {
  return std::make_unique<SizedColliders>(std::move(source), radius_m);
}

}  // namespace vestige
