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

/// Finds contacts with one convex shape for each joint in place of the skin. `Shape` is OrientedBox or Capsule.
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
    row.assign(frame.columns, Contact());
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
      contact = first_contact(frame, frame.segments[i], near_[i]);
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
    if (method_ == Method::kCarried)
      for (const Segment& segment : frame.segments)
        longest_m = std::max(longest_m, glm::distance(glm::dvec3(segment.start), glm::dvec3(segment.end)));
    boxes_.clear();
    boxes_.reserve(moved_.size());
    for (const MovedPart& moved : moved_) boxes_.push_back(around(moved, longest_m));
  }

  /// Returns a box that every segment meets whose way meets the part.
  ///
  /// kCarried: let S and E be the motions at the start and at the end, and D = E - S. |D x| <= moved for every x in the
  /// shape. |D y| <= |D x| + turn |S y - S x| for any other y. The way from a to b meets the shape at x, S a and E b
  /// are the segment's ends. So S b = E b - D b, and with q = |S b - S a|: |D b| <= moved + turn q and q <= length + |D
  /// b|. The point of the segment at the time of x is S x + t D b. So it lies within |D b| of where the shape was.
  SkinBox around(const MovedPart& moved, double longest_m) const {
    constexpr double kSlack = 1e-5;  // far more than the rounding of fp32 within reach of the avatar
    const Shape& shape = moved.part->shape;
    const glm::dvec3 middle = moved.start.to_world(shape.middle);
    double margin = 0;
    if (method_ == Method::kCarried) {
      const glm::dmat3 change = moved.end.linear() - moved.start.linear();
      const double turn = moved.start.relative_size(change);
      if (!(turn < 0.5)) return {glm::vec4(-kEverywhere), glm::vec4(kEverywhere)};
      const double shift = glm::length(moved.end.to_world(shape.middle) - middle) + glm::length(shape.reach(change));
      margin = shift + turn * (longest_m + shift) / (1 - turn);
    }
    const glm::dvec3 reach = shape.reach(moved.start.linear()) + margin + kSlack * (1.0 + glm::abs(middle));
    return {glm::vec4(middle - reach, 0), glm::vec4(middle + reach, 0)};
  }

  /// Finds the parts that each segment may meet.
  void find_pairs(const DetectorFrame& frame) {
    segments_.reset(frame.segments.size());
    for (std::uint32_t i = 0; i < frame.segments.size(); ++i) segments_.add(frame.segments[i], i);
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
    const glm::dvec3 start_bind = moved.start.to_bind(start);
    const glm::dvec3 way_bind = moved.end.to_bind(end) - start_bind;
    const glm::dvec3 place = start_bind + crossing->t * way_bind;
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
  std::vector<Chord> chords_;
};

}  // namespace vestige
