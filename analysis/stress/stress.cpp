#include "analysis/stress/stress.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/common.hpp>
#include <map>
#include <optional>
#include <utility>

#include "detector/broad/skin_motion.hpp"
#include "detector/detectors/contact_description.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/truth/truth.hpp"

namespace vestige {

namespace {

/// Returns whether the point is beyond the same side of the triangle along some axis, both at t = 0 and at t = 1. All
/// motion is linear, so the point is then beyond that side in between too, and the two never meet. Coordinates are only
/// compared, so nothing is rounded.
bool always_apart(const Way& way, const Corners& before, const Corners& now) {
  const auto low = [](const Corners& corners) { return glm::min(glm::min(corners.a, corners.b), corners.c); };
  const auto high = [](const Corners& corners) { return glm::max(glm::max(corners.a, corners.b), corners.c); };
  const glm::dvec3 low_before = low(before);
  const glm::dvec3 low_now = low(now);
  const glm::dvec3 high_before = high(before);
  const glm::dvec3 high_now = high(now);
  for (int axis = 0; axis < 3; ++axis) {
    if (way.start[axis] < low_before[axis] && way.end[axis] < low_now[axis]) return true;
    if (way.start[axis] > high_before[axis] && way.end[axis] > high_now[axis]) return true;
  }
  return false;
}

class Truth {
 public:
  Truth(const StressSubject& subject, const DetectorFrame& frame, Method method)
      : subject_(subject), frame_(frame), method_(method) {
    skin_.skin(subject.avatar, frame, method);
  }

  Contact winner(const Segment& segment) const {
    Contact first;
    for (std::uint32_t triangle = 0; triangle < subject_.avatar.triangles.size(); ++triangle) {
      const Corners now = corners_of(subject_.avatar, skin_.now, triangle);
      Corners before = now;
      if (method_ != Method::kStatic) before = corners_of(subject_.avatar, skin_.before, triangle);
      Way way = {glm::dvec3(segment.start), glm::dvec3(segment.end)};
      if (method_ == Method::kCarried) way.start = glm::dvec3(carried_start(segment.start, before, now));
      if (always_apart(way, method_ == Method::kCcd ? before : now, now)) continue;
      const auto found =
          method_ == Method::kCcd ? exact::ccd_contact(way, before, now) : exact::static_contact(way, now);
      if (!found || found->t >= first.t) continue;  // ascending triangles: a tie goes to the smallest number
      const Corners at_contact = method_ == Method::kCcd ? corners_at(before, now, found->t) : now;
      first = describe_contact(subject_.avatar, subject_.map, {triangle, way, at_contact, *found}, frame_.duration_s);
    }
    return first;
  }

 private:
  const StressSubject& subject_;
  const DetectorFrame& frame_;
  Method method_;
  SkinMotion skin_;
};

void count_row(const ContactRow& row, const ContactRow& truth, StressCount& count) {
  for (std::size_t column = 0; column < truth.size(); ++column) {
    const Contact& given = row[column];
    const Contact& expected = truth[column];
    if (expected.hit()) ++count.contacts;
    if (given.hit() != expected.hit()) {
      ++(given.hit() ? count.false_positives : count.false_negatives);
    } else if (given.triangle != expected.triangle) {
      ++count.wrong_winner;
      ++count.wrong_triangle;
    } else if (std::bit_cast<std::uint32_t>(given.t) != std::bit_cast<std::uint32_t>(expected.t)) {
      ++count.wrong_winner;
      if (given.actuator != expected.actuator) ++count.wrong_actuator;
    } else if (given.actuator != expected.actuator) {
      ++count.wrong_actuator;
    }
  }
}

void count_misses(const DetectorFrame& frame, const ContactRow& row, StressCount& count) {
  count.contacts += frame.columns;
  for (const Contact& given : row)
    if (!given.hit()) ++count.false_negatives;
}

/// The contestants, with a detector for each contestant and body.
class Stress {
 public:
  Stress(const std::vector<StressContestant>& contestants, const StressSettings& settings)
      : contestants_(contestants), settings_(settings) {}

  /// Appends the counts of all contestants. If `keep_going` returns false, appends no counts and returns false.
  bool run(const StressFamily& family, std::size_t magnitude_number, const std::function<bool()>& keep_going,
           std::vector<StressCount>& counts) {
    const std::size_t complete = counts.size();
    const StressSubject& subject = subject_of(family.body);
    const double magnitude = family.magnitudes[magnitude_number];
    for (const Method method : {Method::kStatic, Method::kCarried, Method::kCcd}) {
      if (std::ranges::find(contestants_, method, &StressContestant::method) == contestants_.end()) continue;
      const StressScene scene = family.make({&subject, magnitude, settings_.cases, method,
                                             Random(settings_.seed, name_number(family), magnitude_number)});
      if (scene.judge == StressJudge::kMustHit && method != Method::kStatic) continue;
      const std::vector<ContactRow> truths = truths_of(subject, scene, method);
      for (std::size_t i = 0; i < contestants_.size(); ++i) {
        if (contestants_[i].method != method || (family.has_spheres && !contestants_[i].takes_radii)) continue;
        StressCount& count = counts.emplace_back();
        count.family = family;
        count.magnitude = magnitude;
        count.detector = contestants_[i].detector;
        count.method = method;
        if (judge(detector_of(i, family.body), scene, truths, keep_going, count)) continue;
        counts.resize(complete);
        return false;
      }
    }
    return true;
  }

 private:
  /// Returns a number made of the letters of the name, so that it does not depend on which families run.
  static std::uint64_t name_number(const StressFamily& family) {
    std::uint64_t number = 0;
    for (const std::string_view text : {family.name, family.variant})
      for (const char letter : text) number = number * 131 + static_cast<unsigned char>(letter);
    return number;
  }

  static std::vector<ContactRow> truths_of(const StressSubject& subject, const StressScene& scene, Method method) {
    if (scene.judge == StressJudge::kMustHit) return {};
    std::vector<ContactRow> truths(scene.frames.size());
    for (std::size_t i = 0; i < truths.size(); ++i) stress_truth(subject, scene.frames[i], method, truths[i]);
    return truths;
  }

  static bool judge(Detector& detector, const StressScene& scene, const std::vector<ContactRow>& truths,
                    const std::function<bool()>& keep_going, StressCount& count) {
    ContactRow row;
    for (std::size_t i = 0; i < scene.frames.size(); ++i) {
      if (!keep_going()) return false;
      const DetectorFrame& frame = scene.frames[i];
      count.unsure += detector.detect(frame, row).unsure;
      count.cases += frame.columns;
      if (scene.judge == StressJudge::kMustHit) {
        count_misses(frame, row, count);
      } else {
        count_row(row, truths[i], count);
      }
    }
    return true;
  }

  const StressSubject& subject_of(StressBody body) {
    std::optional<StressSubject>& subject = subjects_[static_cast<std::size_t>(body)];
    if (!subject) subject = make_subject(body);
    return *subject;
  }

  Detector& detector_of(std::size_t contestant, StressBody body) {
    std::unique_ptr<Detector>& detector = detectors_[{contestant, body}];
    if (!detector) detector = contestants_[contestant].make(subject_of(body));
    return *detector;
  }

  const std::vector<StressContestant>& contestants_;
  const StressSettings& settings_;
  std::array<std::optional<StressSubject>, 2> subjects_;
  std::map<std::pair<std::size_t, StressBody>, std::unique_ptr<Detector>> detectors_;
};

}  // namespace

std::vector<StressFamily> stress_families() {
  std::vector<StressFamily> all;
  for (const auto& families : {triangle_families(), pose_families(), watertight_families(), sphere_families()})
    all.insert(all.end(), families.begin(), families.end());
  return all;
}

void stress_truth(const StressSubject& subject, const DetectorFrame& frame, Method method, ContactRow& row) {
  row.clear(frame.columns);
  if (frame.segments.empty()) return;
  if (std::ranges::any_of(frame.segments, &Segment::is_sphere)) {
    const DetectorOptions options = {Surface::kAll, PlaneSet::all(), method};
    make_exact_detector(subject.avatar, subject.map, options)->detect(frame, row);
    return;
  }
  const Truth truth(subject, frame, method);
  for (const Segment& segment : frame.segments) row[segment.column] = truth.winner(segment);
}

std::vector<StressCount> run_stress(const std::vector<StressFamily>& families,
                                    const std::vector<StressContestant>& contestants, const StressSettings& settings,
                                    const std::function<bool(double)>& progress) {
  std::size_t rungs = 0;
  for (const StressFamily& family : families) rungs += family.magnitudes.size();
  std::vector<StressCount> counts;
  Stress stress(contestants, settings);
  std::size_t done = 0;
  for (const StressFamily& family : families)
    for (std::size_t i = 0; i < family.magnitudes.size(); ++i) {
      const double share = static_cast<double>(done++) / static_cast<double>(rungs);
      if (!stress.run(
              family, i, [&] { return progress(share); }, counts))
        return counts;
    }
  return counts;
}

}  // namespace vestige
