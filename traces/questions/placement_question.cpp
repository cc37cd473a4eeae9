#include "traces/questions/placement_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "traces/base/number_text.hpp"
#include "traces/questions/near_skin.hpp"
#include "traces/questions/readings.hpp"

namespace vestige {

namespace {

constexpr std::size_t kMostKept = 128;
/// Fewer colliders than one in so many near the skin: something is asked.
constexpr std::size_t kFew = 100;
/// What is named must bring so many times as many near.
constexpr std::size_t kTimesMore = 10;
/// Where colliders do come near, what is named must fit so many times better.
constexpr double kTimesBetter = 4;
/// A simpler explanation is preferred if it fits this well in comparison to the best one for its simplicity.
constexpr double kAlmostAsGood = 0.9;
/// Where another one fits this well in comparison to the best, which of them is meant cannot be told.
constexpr double kAsGood = 0.5;
/// The mirror image of what is named is named, too, if it fits so much better.
constexpr double kMirrorIsBetter = 1.1;
/// Where so many of all samples are near the skin, nothing is wrong with the axes.
constexpr double kManySamples = 0.05;
/// So many explanations are named.
constexpr std::size_t kMostNamed = 4;
/// A fit below this explains little. Half of all samples that are near, at a tenth of the body's height, have it.
constexpr double kLikely = 0.0005;
/// Colliders that a wrong unit draws together into one point are not where they were meant to be.
constexpr double kLeastExtent_m = 0.1;
/// Colliders that stay within less of the body's height than this may be meant in a larger unit.
constexpr double kSmallScene = 0.5;
/// Colliders that all stay within this are in one point.
constexpr double kPoint_m = 0.001;

/// The colliders of one frame as the file gave them, and the skin of that frame.
struct Moment {
  NearPoints skin;
  std::vector<std::uint32_t> ids;
  std::vector<glm::dvec3> given;
};

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const Pose& pose) {
  return is_finite(pose.origin_m) && std::ranges::all_of(pose.nodes, [](const NodeLocal& node) {
           const glm::quat& q = node.rotation;
           return is_finite(glm::dvec3(node.translation)) && is_finite(glm::dvec3(node.scale)) &&
                  is_finite(glm::dvec3(q.x, q.y, q.z)) && std::isfinite(q.w);
         });
}

using Moments = std::vector<Moment>;

/// How well colliders fit the body, by one reading.
struct Fit {
  std::size_t ids = 0;  ///< colliders that come near the skin
  double share = 0;     ///< of all samples that are near
  double height = 0;    ///< share of the body's height at which samples are near

  Box around = {};  ///< all samples

  /// A unit that makes the scene smaller packs samples more densely, by the third power, at so much less of the height.
  double score() const { return around.longest_side() >= kLeastExtent_m ? share * height * height * height : 0; }
};

Fit fit_of(const Moments& moments, const Convention& convention) {
  constexpr std::size_t kSlices = 10;
  std::set<std::uint32_t> near_ids;
  std::array<bool, kSlices> slices = {};
  std::size_t near = 0;
  std::vector<glm::dvec3> places;
  for (const Moment& moment : moments)
    for (std::size_t i = 0; i < moment.ids.size(); ++i) {
      const glm::dvec3& place_m = places.emplace_back(convention.position_m(moment.given[i]));
      if (!moment.skin.is_near(place_m)) continue;
      near_ids.insert(moment.ids[i]);
      ++near;
      const Box& box = moment.skin.box();
      const double up = (place_m.y - box.low.y) / std::max(box.extent().y, kLeastExtent_m);
      slices[static_cast<std::size_t>(std::clamp(up, 0.0, 0.999) * kSlices)] = true;
    }
  return {near_ids.size(), static_cast<double>(near) / static_cast<double>(places.size()),
          static_cast<double>(std::ranges::count(slices, true)) / kSlices, box_around(places)};
}

/// Takes long where colliders are near, since every point of the skin is looked at.
double nearest_m(const Moments& moments, const Convention& convention) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Moment& moment : moments)
    for (const glm::dvec3& given : moment.given)
      least_m = moment.skin.distance_m(convention.position_m(given), least_m);
  return least_m;
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

struct Candidate {
  Reading reading;
  Fit fit;
};

double best_score(std::span<const Candidate> candidates) {
  double best = 0;
  for (const Candidate& one : candidates) best = std::max(best, one.fit.score());
  return best;
}

/// What changes more must fit as much better. Precondition: there is one.
const Candidate& simplest(std::span<const Candidate> candidates) {
  const auto worth = [](const Candidate& one) { return one.fit.score() / one.reading.changes; };
  const double best = worth(*std::ranges::max_element(candidates, {}, worth));
  return *std::ranges::find_if(candidates, [&](const Candidate& one) { return worth(one) >= kAlmostAsGood * best; });
}

/// A body is about its own mirror image.
bool is_mirror_image(const glm::dmat3& a, const glm::dmat3& b) {
  return glm::dmat3(glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)) * a == b;
}

std::vector<Candidate> as_good_as_best(std::span<const Candidate> candidates) {
  if (candidates.empty()) return {};
  const double best = best_score(candidates);
  std::vector<Candidate> result = {simplest(candidates)};
  const Reading named = result.front().reading;
  const double named_score = result.front().fit.score();
  for (const Candidate& one : candidates) {
    const Convention& other = one.reading.convention;
    if (other == named.convention) continue;
    const double least =
        is_mirror_image(other.axes, named.convention.axes) ? kMirrorIsBetter * named_score : kAsGood * best;
    if (one.fit.score() >= least) result.push_back(one);
  }
  if (result.size() > kMostNamed) result.resize(kMostNamed);
  return result;
}

/// Moves the colliders' middle into that of the body, to a tenth of a metre.
Reading moved(const Moments& moments, const Reading& reading, const glm::dvec3& origin_m) {
  const Convention& convention = reading.convention;
  std::array<std::vector<double>, 3> away;
  for (const Moment& moment : moments)
    for (const glm::dvec3& given : moment.given) {
      const glm::dvec3 distance = (moment.skin.box().low + moment.skin.box().high) * 0.5 - convention.position_m(given);
      for (int axis = 0; axis < 3; ++axis) away[static_cast<std::size_t>(axis)].push_back(distance[axis]);
    }
  Reading other = reading;
  glm::dvec3& offset_m = other.convention.offset_m;
  for (int axis = 0; axis < 3; ++axis)
    offset_m[axis] += std::round(middle_of(std::move(away[static_cast<std::size_t>(axis)])) * 10) / 10;
  const glm::dvec3 by = offset_m - convention.offset_m;
  const glm::dvec3 total = offset_m - origin_m;
  other.words += fmt::format("{}moved by about {:.6g}, {:.6g}, {:.6g} m (a guess: measure it)",
                             reading.words.empty() ? "" : " and ", by.x, by.y, by.z);
  other.changes += 1;
  other.flags += fmt::format("{}--collider-offset={:.6g},{:.6g},{:.6g}", reading.flags.empty() ? "" : " ", total.x,
                             total.y, total.z);
  return other;
}

/// What the colliders would fit better by, each list with the simplest first.
class Candidates {
 public:
  /// `few`: hardly any of them is near as it is.
  Candidates(const Moments& moments, const Convention& convention, const glm::dvec3& origin_m, const Fit& now, bool few)
      : moments_(moments), now_(now), few_(few) {
    std::set<std::uint32_t> ids;
    for (const Moment& moment : moments) ids.insert(moment.ids.begin(), moment.ids.end());
    total_ = ids.size();
    const std::vector<Reading> others = other_readings(convention);
    const double height_m = moments.front().skin.box().extent().y;
    const bool is_small = now.around.longest_side() < kSmallScene * height_m;
    for (const Reading& reading : others) {
      // Where colliders do come near, only wrong axes explain that others would do so more, or a unit that makes the
      // whole scene small.
      const bool is_larger = reading.convention.metres_per_unit > convention.metres_per_unit;
      if (few || !reading.has_other_unit || (is_small && is_larger)) add(reading, plain_);
    }
    if (!few) return;
    add(moved(moments, {convention, "", ""}, origin_m), moved_);
    for (const Reading& reading : others)
      if (!reading.has_other_columns) add(moved(moments, reading, origin_m), both_);
  }

  /// Returns the one to name, and then others that may be meant as well; nothing if none is better than what is. An
  /// offset, which can be of any size, is named first only where nothing without a number is likely, or brings half as
  /// many.
  std::vector<Candidate> best() const {
    const bool is_moved = !moved_.empty() && best_score(moved_) > kTimesBetter * best_score(plain_);
    if (best_score(plain_) >= kLikely || !(is_moved || best_score(both_) >= kLikely)) {
      std::vector<Candidate> result = as_good_as_best(plain_);
      if (is_moved && moved_.front().fit.ids > 2 * result.front().fit.ids)
        result.insert(result.begin(), moved_.front());
      return result;
    }
    if (best_score(moved_) < kLikely && best_score(both_) >= kLikely) return as_good_as_best(both_);
    std::vector<Candidate> result = {moved_.front()};
    if (best_score(both_) > kTimesBetter * best_score(moved_)) result.push_back(simplest(both_));
    return result;
  }

 private:
  void add(const Reading& reading, std::vector<Candidate>& candidates) {
    const Fit fit = fit_of(moments_, reading.convention);
    if (fit.score() > 0 && (few_ ? brings_more(fit) : fits_better(fit, reading))) candidates.push_back({reading, fit});
  }

  bool brings_more(const Fit& fit) const { return fit.ids >= std::max<std::size_t>(1, kTimesMore * now_.ids); }

  /// Colliders near the floor fit better if they are stood upright, however right they are: so many of them must come
  /// near that do not do so now.
  bool fits_better(const Fit& fit, const Reading& reading) const {
    if (fit.score() < kTimesBetter * now_.score() || 2 * fit.ids < total_) return false;
    if (reading.has_other_unit) return 2 * fit.ids >= now_.ids;
    return fit.ids > now_.ids && now_.share < kManySamples;
  }

  const Moments& moments_;
  const Fit& now_;
  bool few_ = false;
  std::size_t total_ = 0;         ///< colliders
  std::vector<Candidate> plain_;  ///< without an offset
  std::vector<Candidate> moved_;  ///< with one alone: at most one
  std::vector<Candidate> both_;   ///< with an offset and more
};

}  // namespace

void PlacementQuestion::see(const TraceFrame& frame) {
  for (const ColliderSample& collider : frame.colliders) ids_.insert(collider.id);
  if (seen_++ % step_ != 0) return;
  kept_.push_back(frame);
  if (kept_.size() < 2 * kMostKept) return;
  for (std::size_t i = 0; i < kMostKept; ++i) std::swap(kept_[i], kept_[2 * i]);
  kept_.resize(kMostKept);
  step_ *= 2;
}

std::optional<std::string> PlacementQuestion::ask() const {
  Moments moments;
  for (const TraceFrame& frame : kept_) {
    if (frame.colliders.empty() || !is_finite(frame.poses.front())) continue;
    Moment moment = {NearPoints(sampler_.points_m(frame.poses.front())), {}, {}};
    for (const ColliderSample& collider : frame.colliders) {
      if (!is_finite(collider.position_m)) continue;
      moment.ids.push_back(collider.id);
      moment.given.push_back(convention_.given_position(collider.position_m));
    }
    if (!moment.ids.empty()) moments.push_back(std::move(moment));
  }
  if (moments.empty()) return std::nullopt;

  const Fit now = fit_of(moments, convention_);
  const bool few = now.ids * kFew < ids_.size();
  const std::string total = counted(ids_.size(), "collider");
  const std::string near = fmt::format("within {:g} cm", NearPoints::kNear_m * 100);
  const std::string stays =
      now.ids == 0
          ? fmt::format("the nearest of {} stays {:.3g} m away from the skin", total, nearest_m(moments, convention_))
          : fmt::format("{} of {} {} {} of the skin, in {:.1f} % of all samples", now.ids, total,
                        now.ids == 1 ? "comes" : "come", near, 100 * now.share);
  const std::vector<Candidate> best = Candidates(moments, convention_, origin_m_, now, few).best();
  if (best.empty() && ids_.size() > 1 && now.around.longest_side() < kPoint_m) {
    const glm::dvec3& place_m = now.around.low;
    return fmt::format("all {} stay in one point, {:.3g}, {:.3g}, {:.3g} m; check what the columns x, y, z hold", total,
                       place_m.x, place_m.y, place_m.z);
  }
  if (best.empty()) return few ? std::optional(stays) : std::nullopt;
  const auto& [reading, fit] = best.front();
  const std::string would = now.ids == 0 ? fmt::format("would come {}", near) : "would";
  std::string question = fmt::format("{}; {}, {} {}, in {:.1f} %: {}", stays, reading.words, fit.ids, would,
                                     100 * fit.share, reading.flags);
  std::vector<std::string> others;
  for (const auto& [other, its_fit] : std::span(best).subspan(1))
    others.push_back(
        fmt::format("or {}: {:.1f} %", other.has_other_columns ? other.words : other.flags, 100 * its_fit.share));
  if (!others.empty()) question += fmt::format(" ({})", fmt::join(others, ", "));
  return question;
}

}  // namespace vestige
