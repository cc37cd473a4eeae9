#include "detector/broad/skin_motion.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/contact_description.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/truth/truth.hpp"

namespace vestige {

namespace {

/// Tests every segment against every triangle by `exact::`. The contract defines skinning, carrying and the description
/// of a contact, so this detector shares that code. All decisions, including the winner, are this detector's own.
class ExactDetector final : public Detector {
 public:
  ExactDetector(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : avatar_(avatar), map_(map), options_(options) {}

  const char* name() const override { return "exact"; }
  Method method() const override { return options_.method; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {};
    enter(Stage::kSkinning);
    skin_.skin(avatar_, frame, options_.method);
    enter(Stage::kDecision);
    for (const Segment& segment : frame.segments)
      row[segment.column] = segment.is_sphere() ? first_touch(frame, segment) : first_contact(frame, segment);
    const std::uint64_t pairs = frame.segments.size() * avatar_.triangles.size();
    return {.pairs_tested = pairs, .triangles_tested = avatar_.triangles.size()};
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  Contact first_contact(const DetectorFrame& frame, const Segment& segment) const {
    Contact first;
    for (std::uint32_t triangle = 0; triangle < avatar_.triangles.size(); ++triangle) {
      const Contact contact = contact_with(frame, segment, triangle);
      const bool counts = contact.hit() && (options_.surface == Surface::kAll || contact.actuator != 0);
      if (counts && contact.t < first.t) first = contact;  // triangles ascend, so the smallest number wins a tie
    }
    return first;
  }

  Contact contact_with(const DetectorFrame& frame, const Segment& segment, std::uint32_t triangle) const {
    const Corners now = corners_of(avatar_, skin_.now, triangle);
    Corners at_contact = now;
    Way way = {glm::dvec3(segment.start), glm::dvec3(segment.end)};
    std::optional<FirstContact> found;
    if (options_.method == Method::kCcd) {
      const Corners before = corners_of(avatar_, skin_.before, triangle);
      found = exact::ccd_contact(way, before, now);
      if (found) at_contact = corners_at(before, now, found->t);
    } else {
      if (options_.method == Method::kCarried)
        way.start = glm::dvec3(carried_start(segment.start, corners_of(avatar_, skin_.before, triangle), now));
      found = exact::static_contact(way, now);
    }
    if (!found) return {};
    return describe_contact(avatar_, map_, {triangle, way, at_contact, *found}, frame.duration_s);
  }

  /// What first_touch compares: a contact, and the pair whose distance at the start counts if it touches there.
  struct SphereTouch {
    Contact contact;
    SpherePair pair;
    bool at_start = false;

    exact::Apart apart() const { return {pair.sphere.centre.start, pair.before}; }
  };

  /// Compares contacts at the same t by the distance at the exact first time, which is the radius except at the start.
  static bool is_nearer(const SphereTouch& a, const SphereTouch& b) {
    const double radius = a.pair.sphere.radius;
    if (a.at_start && b.at_start) return exact::compare_distances(a.apart(), b.apart()) < 0;
    return a.at_start && exact::compare_distance(a.apart(), radius) < 0;
  }

  Contact first_touch(const DetectorFrame& frame, const Segment& segment) const {
    std::optional<SphereTouch> best;
    for (std::uint32_t triangle = 0; triangle < avatar_.triangles.size(); ++triangle) {
      const Corners now = corners_of(avatar_, skin_.now, triangle);
      const Corners before = options_.method == Method::kStatic ? now : corners_of(avatar_, skin_.before, triangle);
      const SpherePair pair = sphere_pair(segment, {before, now}, triangle, options_.method);
      const std::optional<FirstTouch> touch = exact::sphere_contact(pair.sphere, pair.before, pair.now);
      if (!touch || (best && touch->t > best->contact.t)) continue;
      const SphereTouch candidate = {describe_touch(avatar_, map_, pair, *touch, frame.duration_s), pair,
                                     touch->at_start};
      if (options_.surface == Surface::kMapped && candidate.contact.actuator == 0) continue;
      // Triangles ascend, so the smallest number wins a tie.
      if (!best || candidate.contact.t < best->contact.t || is_nearer(candidate, *best)) best = candidate;
    }
    return best ? best->contact : Contact();
  }

  const Avatar& avatar_;
  const ActuatorMap& map_;
  DetectorOptions options_;
  SkinMotion skin_;
};

}  // namespace

std::unique_ptr<Detector> make_exact_detector(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options) {
  return std::make_unique<ExactDetector>(avatar, map, options);
}

}  // namespace vestige
