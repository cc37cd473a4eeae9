#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "detector/approximate/joint_skin.hpp"
#include "detector/approximate/moving_frame.hpp"
#include "detector/approximate/skin_spots.hpp"
#include "detector/approximate/union_surface.hpp"
#include "detector/broad/segment_boxes.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// Finds contacts with one convex shape for each joint in place of the skin. `Shape` is OrientedBox or Capsule. A
/// sphere touches where its centre is within a shape that is grown by its radius, and in none that is shrunk by it.
template <typename Shape>
class ShapeDetector final : public Detector {
 public:
  ShapeDetector(const char* name, const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : name_(name), avatar_(avatar), method_(options.method), surface_(options.surface) {
    for (const JointSkin& skin : skin_by_joint(avatar)) {
      Part part = {skin.palette, Shape::fit(skin.patch.corners()), {}};
      part.spots.reserve(Shape::kCells);
      for (std::size_t cell = 0; cell < Shape::kCells; ++cell)
        part.spots.push_back(nearest_spot(avatar, map, {&skin.patch, 1}, part.shape.middle_of_cell(cell)));
      parts_.push_back(std::move(part));
    }
  }

  const char* name() const override { return name_; }
  Method method() const override { return method_; }
  bool is_approximate() const override { return true; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {};
    enter(Stage::kSkinning);
    move_parts(frame);
    enter(Stage::kCandidates);
    bound_parts(frame);
    find_pairs(frame);
    DetectorWork work;
    for (std::size_t i = 0; i < frame.segments.size(); ++i) {
      if (near_[i].empty()) continue;
      work.pairs_tested += near_[i].size();
      Contact& contact = row[frame.segments[i].column];
      const Segment& segment = frame.segments[i];
      contact =
          segment.is_sphere() ? first_touch_of(frame, segment, near_[i]) : first_contact(frame, segment, near_[i]);
      if (contact.hit()) ++work.pairs_meeting;
    }
    return work;
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  struct Part {
    std::size_t palette;
    Shape shape;
    std::vector<SkinSpot> spots;  ///< one for each cell
  };

  /// A part whose joint is not scaled to nothing: where it is at a way's start, and at its end.
  struct MovedPart {
    const Part* part;
    MovingFrame start;  ///< kStatic: as `end`
    MovingFrame end;
  };

  void move_parts(const DetectorFrame& frame) {
    moved_.clear();
    for (const Part& part : parts_) {
      const MovingFrame end(frame.palette[part.palette]);
      const MovingFrame start = method_ == Method::kCarried ? MovingFrame(frame.palette_before[part.palette]) : end;
      if (!start.is_regular() || !end.is_regular()) continue;
      moved_.push_back({&part, start, end});
    }
  }

  void bound_parts(const DetectorFrame& frame) {
    double longest_m = 0;
    double largest_m = 0;
    for (const Segment& segment : frame.segments) {
      largest_m = std::max(largest_m, static_cast<double>(segment.radius_m));
      if (method_ == Method::kCarried)
        longest_m = std::max(longest_m, glm::distance(glm::dvec3(segment.start), glm::dvec3(segment.end)));
    }
    boxes_.clear();
    boxes_.reserve(moved_.size());
    for (const MovedPart& moved : moved_) boxes_.push_back(around(moved, longest_m, largest_m));
  }

  /// Returns a box that every segment meets whose way meets the part; of a sphere, every segment with room for
  /// `kGrowth` times its radius. `largest_m` is the largest radius.
  ///
  /// kCarried: let S and E be the motions at the start and at the end, and D = E - S. |D x| <= moved for every x in the
  /// shape. |D y| <= |D x| + turn |S y - S x| for any other y. The way from a to b meets the shape at x, S a and E b
  /// are the segment's ends. So S b = E b - D b, and with q = |S b - S a|: |D b| <= moved + turn q and q <= length + |D
  /// b|. The point of the segment at the time of x is S x + t D b. So it lies within |D b| of where the shape was.
  SkinBox around(const MovedPart& moved, double longest_m, double largest_m) const {
    constexpr double kSlack = 1e-5;  // far more than the rounding of fp32 within reach of the avatar
    const Shape& shape = moved.part->shape;
    const glm::dvec3 middle = moved.start.to_world(shape.middle);
    double margin = 0;
    if (method_ == Method::kCarried) {
      const glm::dmat3 change = moved.end.linear() - moved.start.linear();
      const double turn = moved.start.relative_size(change);
      if (!(turn < 0.5)) return {glm::vec4(-kEverywhere), glm::vec4(kEverywhere)};
      const double shift = glm::length(moved.end.to_world(shape.middle) - middle) + glm::length(shape.reach(change)) +
                           turn * kGrowth * largest_m;
      margin = shift + turn * (longest_m + shift) / (1 - turn);
    }
    const glm::dvec3 reach = shape.reach(moved.start.linear()) + margin + kSlack * (1.0 + glm::abs(middle));
    return {glm::vec4(middle - reach, 0), glm::vec4(middle + reach, 0)};
  }

  /// Finds the parts that each segment may meet.
  void find_pairs(const DetectorFrame& frame) {
    segments_.reset(frame.segments.size());
    for (std::uint32_t i = 0; i < frame.segments.size(); ++i) {
      Segment roomy = frame.segments[i];
      roomy.radius_m *= static_cast<float>(kGrowth);
      segments_.add(roomy, i);
    }
    near_.resize(frame.segments.size());
    for (auto& list : near_) list.clear();
    for (std::size_t first = 0; first < boxes_.size(); first += SegmentBoxes::kMostTested) {
      const std::size_t count = std::min(SegmentBoxes::kMostTested, boxes_.size() - first);
      segments_.test(std::span(boxes_).subspan(first, count));
      for (std::size_t k = 0; k < count; ++k)
        segments_.visit_met(k, [&](std::size_t i) { near_[i].push_back(first + k); });
    }
  }

  Contact first_contact(const DetectorFrame& frame, const Segment& segment, std::span<const std::size_t> near) {
    enter(Stage::kTest);
    chords_.clear();
    for (const std::size_t i : near) {
      const MovedPart& moved = moved_[i];
      chords_.push_back(moved.part->shape.chord(moved.start.to_bind(glm::dvec3(segment.start)),
                                                moved.end.to_bind(glm::dvec3(segment.end))));
    }
    const std::optional<Crossing> crossing = first_crossing(chords_);
    if (!crossing) return {};
    enter(Stage::kDecision);
    const MovedPart& moved = moved_[near[crossing->chord]];
    const glm::dvec3 start(segment.start);
    const glm::dvec3 end(segment.end);
    const glm::dvec3 way_bind = moved.end.to_bind(end) - moved.start.to_bind(start);
    const glm::dvec3 place = place_in(moved, start, end, crossing->t);
    const SkinSpot& spot = moved.part->spots[moved.part->shape.cell(place)];
    if (surface_ == Surface::kMapped && spot.actuator == 0) return {};
    Contact contact;
    put_spot(spot, contact);
    contact.t = static_cast<float>(crossing->t);
    contact.side = crossing->side;
    contact.position = start + crossing->t * (end - start);
    const glm::dvec3 normal = moved.part->shape.normal(place);
    if (frame.duration_s > 0)
      contact.speed_m_per_s =
          std::abs(glm::dot(normal, way_bind)) / glm::length(moved.end.normal_to_world(normal)) / frame.duration_s;
    return contact;
  }

  Contact first_touch_of(const DetectorFrame& frame, const Segment& segment, std::span<const std::size_t> near) {
    enter(Stage::kTest);
    const glm::dvec3 start(segment.start);
    const glm::dvec3 end(segment.end);
    const auto radius_of = [&](const MovedPart& moved) { return segment.radius_m / moved.end.scale(); };
    chords_.clear();
    shrunk_.clear();
    for (const std::size_t i : near) {
      const MovedPart& moved = moved_[i];
      const glm::dvec3 from = moved.start.to_bind(start);
      const glm::dvec3 to = moved.end.to_bind(end);
      chords_.push_back(moved.part->shape.grown(radius_of(moved)).chord(from, to));
      shrunk_.push_back(moved.part->shape.grown(-radius_of(moved)).chord(from, to));
    }
    const std::optional<double> t = first_touch(chords_, shrunk_);
    if (!t) return {};
    enter(Stage::kDecision);
    // Of the parts that it touches, the one whose surface is nearest.
    const MovedPart* nearest = nullptr;
    double least = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (!(chords_[k].enter <= *t && *t <= chords_[k].leave)) continue;
      const MovedPart& moved = moved_[near[k]];
      const double away = std::abs(moved.part->shape.height(place_in(moved, start, end, *t))) / radius_of(moved);
      if (nearest != nullptr && away >= least) continue;
      nearest = &moved;
      least = away;
    }
    const Shape& shape = nearest->part->shape;
    const glm::dvec3 place = place_in(*nearest, start, end, *t);
    const SkinSpot& spot = nearest->part->spots[shape.cell(place)];
    if (surface_ == Surface::kMapped && spot.actuator == 0) return {};
    Contact contact;
    put_spot(spot, contact);
    const double height = shape.height(place);
    contact.t = static_cast<float>(*t);
    contact.side = height >= 0 ? std::int8_t{1} : std::int8_t{-1};
    const glm::dvec3 normal = shape.normal(place);
    const glm::dvec3 outwards = nearest->end.normal_to_world(normal);
    const double length = glm::length(outwards);
    contact.position = start + *t * (end - start) - height * nearest->end.scale() / length * outwards;
    if (frame.duration_s > 0) {
      const glm::dvec3 way_bind = nearest->end.to_bind(end) - nearest->start.to_bind(start);
      contact.speed_m_per_s = std::abs(glm::dot(normal, way_bind)) / length / frame.duration_s;
    }
    return contact;
  }

  /// Returns where, in bind space, a way is at time t.
  static glm::dvec3 place_in(const MovedPart& moved, const glm::dvec3& start, const glm::dvec3& end, double t) {
    const glm::dvec3 from = moved.start.to_bind(start);
    return from + t * (moved.end.to_bind(end) - from);
  }

  /// How much farther than a radius a shape that is grown by it may reach: at a box's corners, sqrt(3), and where the
  /// joint stretches lengths unevenly, sqrt(3) times their root mean square.
  static constexpr double kGrowth = 3;
  static constexpr float kEverywhere = std::numeric_limits<float>::infinity();

  const char* name_;
  const Avatar& avatar_;
  Method method_;
  Surface surface_;
  std::vector<Part> parts_;
  std::vector<MovedPart> moved_;
  std::vector<SkinBox> boxes_;  ///< one for each of `moved_`
  SegmentBoxes segments_;
  std::vector<std::vector<std::size_t>> near_;  ///< for each segment: the numbers in `moved_` that it may meet
  std::vector<Chord> chords_;  ///< with the parts that a segment may meet; of a sphere, with those that are grown
  std::vector<Chord> shrunk_;
};

}  // namespace vestige
