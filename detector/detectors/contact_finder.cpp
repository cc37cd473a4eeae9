#include "detector/detectors/contact_finder.hpp"

#include <bit>
#include <utility>

#include "detector/decision.hpp"
#include "detector/detectors/contact_description.hpp"

namespace vestige {

void ContactFinder::offer(const DetectorFrame& frame, const MovingCorners& corners, const Segment& segment,
                          std::uint32_t triangle, Contact& winner) {
  if (segment.is_sphere()) {
    spheres_.offer(frame, corners, segment, triangle);
    return;
  }
  const auto& [before, now] = corners;
  Way way = {glm::dvec3(segment.start), glm::dvec3(segment.end)};
  if (method_ == Method::kCarried) way.start = glm::dvec3(carried_start(segment.start, before, now));

  const Decision decision = method_ == Method::kCcd ? decide_ccd(way, before, now) : decide_static(way, now);
  if (decision.exact_arithmetic) ++unsure_;
  if (!decision.contact) return;
  ++meeting_;
  const float t = decision.contact->t;
  if (t > winner.t || (t == winner.t && triangle > winner.triangle)) return;
  const Corners at_contact = method_ == Method::kCcd ? corners_at(before, now, t) : now;
  const Contact contact =
      describe_contact(avatar_, map_, {triangle, way, at_contact, *decision.contact}, frame.duration_s);
  if (surface_ == Surface::kMapped && contact.actuator == 0) return;
  winner = contact;
}

void ContactFinder::offer(const DetectorFrame& frame, const MeshletPlaces& meshlet, const Segment& segment,
                          std::uint32_t bits, ContactRow& row) {
  if (segment.is_sphere()) {
    spheres_.offer(frame, meshlet, segment, bits);
    return;
  }
  for (; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    offer(frame, meshlet.at(i), segment, meshlet.triangles[i], row[segment.column]);
  }
}

void ContactFinder::finish(const DetectorFrame& frame, ContactRow& row, DetectorWork& work) {
  const SphereCounts spheres = spheres_.finish(frame, row);
  work.pairs_meeting = std::exchange(meeting_, 0) + spheres.meeting;
  work.unsure = std::exchange(unsure_, 0) + spheres.unsure;
}

}  // namespace vestige
