#include "detector/depth/depth_detector.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "detector/depth/skin_distance.hpp"

namespace vestige {

namespace {

class DepthDetector final : public Detector {
 public:
  DepthDetector(std::unique_ptr<Detector> detector, const Avatar& avatar)
      : detector_(std::move(detector)), distance_(avatar) {}

  const char* name() const override { return detector_->name(); }
  Method method() const override { return detector_->method(); }
  Skip skip() const override { return detector_->skip(); }
  std::uint64_t run_length() const override { return detector_->run_length(); }
  bool is_approximate() const override { return detector_->is_approximate(); }
  std::optional<std::size_t> triangles_kept() const override { return detector_->triangles_kept(); }
  GlInfo gl_info() const override { return detector_->gl_info(); }
  bool skins_in_shader() const override { return detector_->skins_in_shader(); }
  std::size_t triangles_left_out() const override { return detector_->triangles_left_out(); }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    const DetectorWork work = detector_->detect(frame, row);
    bool begun = false;
    for (const Segment& segment : frame.segments) {
      Contact& contact = row[segment.column];
      if (!contact.hit() || !segment.is_sphere()) continue;
      if (!begun) {
        enter(Stage::kDecision);
        distance_.begin(frame);
      }
      begun = true;
      const double radius_m = segment.radius_m;
      contact.depth_m = std::clamp(radius_m - distance_.signed_m(glm::dvec3(segment.end)), 0.0, 2 * radius_m);
    }
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    detector_->skinned_vertices(frame, out);
  }

  void time_stages(StageClock* clock) override {
    Detector::time_stages(clock);
    detector_->time_stages(clock);
  }

 private:
  std::unique_ptr<Detector> detector_;
  SkinDistance distance_;
};

}  // namespace

std::unique_ptr<Detector> with_depth(std::unique_ptr<Detector> detector, const Avatar& avatar) {
  return std::make_unique<DepthDetector>(std::move(detector), avatar);
}

}  // namespace vestige
