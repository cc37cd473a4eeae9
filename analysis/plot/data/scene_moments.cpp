#include "analysis/plot/data/scene_moments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / 1e9;
}

std::vector<FrameTime> evenly(const std::vector<FrameTime>& times, std::size_t count) {
  std::vector<FrameTime> chosen;
  const double first_s = times.front().time_s;
  const double duration_s = times.back().time_s - first_s;
  for (std::size_t i = 1; i <= count; ++i) {
    // The first frame has no past to show. The last frame has all of it.
    const double wish_s = first_s + duration_s * static_cast<double>(i) / static_cast<double>(count);
    auto found = std::ranges::lower_bound(times, wish_s - 1e-9, {}, &FrameTime::time_s);
    if (found == times.end()) --found;
    if (chosen.empty() || found->index != chosen.back().index) chosen.push_back(*found);
  }
  return chosen;
}

/// The most stops of a path, at any frame rate: about as many as a page can show.
constexpr double kMostStops = 400;

/// Colliders' recent places, by id.
class Trails {
 public:
  explicit Trails(double length_s) : length_s_(length_s) {}

  void add(const TraceFrame& frame) {
    const double time_s = seconds(frame.time_ns);
    for (auto& [id, trail] : trails_) trail.is_current = false;
    for (const std::uint32_t id : frame.teleported) finish(id);
    for (const ColliderSample& collider : frame.colliders) {
      const glm::dvec3& at = collider.position_m;
      if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) continue;
      Path& trail = trails_[collider.id];
      trail.collider = collider.id;
      trail.is_current = true;
      trail.radius_m = collider.radius_m;
      thin(trail);
      trail.stops.push_back({time_s, at});
    }
    std::vector<std::uint32_t> gone;
    for (const auto& [id, trail] : trails_)
      if (!trail.is_current) gone.push_back(id);
    for (const std::uint32_t id : gone) finish(id);
    for (auto& [id, trail] : trails_) forget(trail, time_s);
    for (Path& trail : finished_) forget(trail, time_s);
    std::erase_if(finished_, [](const Path& trail) { return trail.stops.empty(); });
  }

  std::vector<Path> paths(double time_s) const {
    std::vector<Path> result = finished_;
    for (const auto& [id, trail] : trails_) result.push_back(trail);
    for (Path& path : result)
      for (Path::Stop& stop : path.stops) stop.age_s = time_s - stop.age_s;
    return result;
  }

 private:
  void finish(std::uint32_t id) {
    const auto found = trails_.find(id);
    if (found == trails_.end()) return;
    found->second.is_current = false;
    finished_.push_back(std::move(found->second));
    trails_.erase(found);
  }

  /// Called before a stop is added. The last stop begins the segment that is tested next; the stop before it may be
  /// dropped.
  void thin(Path& trail) const {
    const std::size_t count = trail.stops.size();
    if (count < 3) return;
    if (trail.stops[count - 1].age_s - trail.stops[count - 3].age_s < length_s_ / kMostStops)
      trail.stops.erase(trail.stops.end() - 2);
  }

  /// Forgets old stops. The segment to the newest place stays, however old its beginning is.
  void forget(Path& trail, double time_s) const {
    const auto is_young = [&](const Path::Stop& stop) { return time_s - stop.age_s <= length_s_ + 1e-9; };
    auto first = std::ranges::find_if(trail.stops, is_young);
    if (trail.is_current && std::distance(first, trail.stops.end()) < 2 && first != trail.stops.begin()) --first;
    trail.stops.erase(trail.stops.begin(), first);
  }

  double length_s_;
  std::map<std::uint32_t, Path> trails_;  ///< until `paths`, age_s holds the time itself
  std::vector<Path> finished_;
};

}  // namespace

std::vector<FrameTime> frame_times(TraceReader& trace, std::string_view name) {
  std::vector<FrameTime> times;
  TraceFrame frame;
  while (trace.next(frame)) times.push_back({frame.index, seconds(frame.time_ns)});
  if (times.empty()) {
    std::string cause = "holds no frame";
    for (const std::string& warning : trace.warnings()) cause += "\n  " + warning;
    throw Error(name, cause, "record again");
  }
  trace.rewind();
  return times;
}

std::vector<Moment> read_moments(TraceReader& trace, std::string_view name, std::vector<FrameTime> times,
                                 const MomentChoice& choice, std::span<const RecordedContact> contacts) {
  if (choice.from_s > choice.to_s)
    throw UsageError("--from, --to", fmt::format("{} s is after {} s", choice.from_s, choice.to_s), "exchange the two");
  const std::string span = fmt::format("from {} s to {} s", times.front().time_s, times.back().time_s);
  std::erase_if(times, [&](const FrameTime& at) { return at.time_s < choice.from_s || at.time_s > choice.to_s; });
  if (times.empty())
    throw UsageError("--from, --to", fmt::format("{} lasts {}, and has no frame in that time", name, span),
                     "choose a time within the trace");

  std::map<std::uint64_t, double> time_of;
  for (const FrameTime& at : times) time_of[at.index] = at.time_s;
  std::vector<FrameTime> chosen;
  if (contacts.empty()) {
    chosen = evenly(times, choice.count);
  } else {
    std::set<std::uint64_t> touched;
    for (const RecordedContact& contact : contacts)
      if (time_of.contains(contact.frame)) touched.insert(contact.frame);
    if (touched.empty())
      throw UsageError("--contacts", fmt::format("the frames of {} that are drawn have no contact", name),
                       "widen --from and --to, or leave --contacts out");
    const std::vector<std::uint64_t> frames(touched.begin(), touched.end());
    for (std::size_t i = 0; i < std::min(choice.count, frames.size()); ++i) {
      const std::size_t picks = std::min(choice.count, frames.size());
      const std::uint64_t frame = frames[(2 * i + 1) * frames.size() / (2 * picks)];
      chosen.push_back({frame, time_of[frame]});
    }
  }

  std::vector<Moment> moments;
  Trails trails(choice.trail_s);
  std::map<std::uint64_t, double> passed;  // frames up to the moment, with their times
  TraceFrame frame;
  while (moments.size() < chosen.size() && trace.next(frame)) {
    const FrameTime& wanted = chosen[moments.size()];
    const double time_s = seconds(frame.time_ns);
    passed[frame.index] = time_s;
    trails.add(frame);
    if (frame.index != wanted.index) continue;
    Moment moment = {frame.index, time_s, frame.poses, trails.paths(time_s), {}};
    for (const RecordedContact& contact : contacts) {
      const auto at = passed.find(contact.frame);
      if (at != passed.end() && time_s - at->second <= choice.trail_s + 1e-9) moment.contacts.push_back(contact);
    }
    moments.push_back(std::move(moment));
  }
  return moments;
}

}  // namespace vestige::plot
