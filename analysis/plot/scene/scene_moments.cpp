#include "analysis/plot/scene/scene_moments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

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

}  // namespace

std::vector<FrameTime> frame_times(TraceReader& trace, std::string_view name) {
  std::vector<FrameTime> times;
  TraceFrame frame;
  while (trace.next(frame)) times.push_back({frame.index, frame.time_s()});
  if (times.empty()) {
    std::string cause = "holds no frame";
    for (const std::string& warning : trace.warnings()) cause += "\n  " + warning;
    throw Error(name, cause, "record again");
  }
  trace.rewind();
  return times;
}

void require_order(double from_s, double to_s) {
  if (from_s > to_s)
    throw UsageError("--from, --to", fmt::format("{} s is after {} s", from_s, to_s), "exchange the two");
}

void refuse_empty_span(std::string_view name, double first_s, double last_s) {
  throw UsageError("--from, --to",
                   fmt::format("{} lasts from {} s to {} s, and has no frame in that time", name, first_s, last_s),
                   "choose a time within the trace, that is at least as long as from one frame to the next");
}

std::vector<Moment> read_moments(TraceReader& trace, std::string_view name, std::vector<FrameTime> times,
                                 const MomentChoice& choice, std::span<const RecordedContact> contacts) {
  require_order(choice.from_s, choice.to_s);
  const double first_s = times.front().time_s;
  const double last_s = times.back().time_s;
  std::erase_if(times, [&](const FrameTime& at) { return at.time_s < choice.from_s || at.time_s > choice.to_s; });
  if (times.empty()) refuse_empty_span(name, first_s, last_s);

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
    const double time_s = frame.time_s();
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
