#include "detector/contact_finder.hpp"
#include "detector/detector.hpp"
#include "detector/skin_motion.hpp"
#include "detector/triangle_boxes.hpp"

namespace vestige {

namespace {

class CpuDetector final : public Detector {
 public:
  CpuDetector(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), method_(options.method), finder_(avatar, map, options) {}

  const char* name() const override { return "cpu"; }
  Method method() const override { return method_; }

  DetectorWork detect(const Frame& frame, ContactRow& row) override {
    row.assign(frame.columns, Contact());
    if (frame.segments.empty()) return {};
    skin_.skin(avatar_, frame, method_);
    boxes_.build(avatar_, skin_, method_);
    for (const Segment& segment : frame.segments)
      boxes_.meet(segment,
                  [&](std::uint32_t triangle) { finder_.offer(frame, skin_, segment, triangle, row[segment.column]); });
    return {.pairs_tested = frame.segments.size() * avatar_.triangles.size(),
            .triangles_tested = avatar_.triangles.size(),
            .pairs_meeting = finder_.take_meeting(),
            .unsure = finder_.take_unsure()};
  }

  void skinned_vertices(const Frame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  const Avatar& avatar_;
  Method method_;
  ContactFinder finder_;
  SkinMotion skin_;
  TriangleBoxes boxes_;
};

}  // namespace

std::unique_ptr<Detector> make_cpu_detector(const Avatar& avatar, const ActuatorMap& map,
                                            const DetectorOptions& options) {
  return std::make_unique<CpuDetector>(avatar, map, options);
}

}  // namespace vestige
