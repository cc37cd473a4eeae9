#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "traces/exchange/collider_files.hpp"
#include "traces/exchange/collider_rows.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

namespace {

/// Whether the collider moved here from the previous sample, or was absent or elsewhere in between.
enum class Arrival { kMoved, kApart };

struct Sample {
  double time_s = 0;
  glm::dvec3 position_m = glm::dvec3(0);
  Arrival arrival = Arrival::kMoved;
};

using Samples = std::map<std::uint32_t, std::vector<Sample>>;

Samples parse(ColliderRows& rows) {
  Samples samples;
  std::map<std::uint32_t, std::uint64_t> last_frame;
  ColliderRow row;
  while (rows.next(row)) {
    auto& of_collider = samples[row.sample.id];
    if (!of_collider.empty() && of_collider.back().time_s == row.time_s)
      throw rows.error(fmt::format("collider {} has two positions at {} s", row.sample.id, row.time_s),
                       "remove one of them");
    Sample sample = {row.time_s, row.sample.position_m, Arrival::kMoved};
    if (rows.columns() == ColliderColumns::kFrames) {
      const auto [last, is_first] = last_frame.try_emplace(row.sample.id, row.frame);
      if (row.teleported || (!is_first && row.frame != last->second + 1)) sample.arrival = Arrival::kApart;
      last->second = row.frame;
    }
    of_collider.push_back(sample);
  }
  // The export of a trace without colliders has no rows, so there is no time span to record.
  if (samples.empty()) throw Error(rows.name(), "holds no sample", "name a file with at least one row");
  return samples;
}

class CsvColliders final : public ColliderSource {
 public:
  explicit CsvColliders(const Samples& samples) {
    span_s_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& [id, of_collider] : samples) {
      tracks_.push_back({id, of_collider, 0});
      span_s_.first_s = std::min(span_s_.first_s, of_collider.front().time_s);
      span_s_.last_s = std::max(span_s_.last_s, of_collider.back().time_s);
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    for (Track& track : tracks_) {
      bool is_apart = false;
      for (; track.next < track.samples.size() && track.samples[track.next].time_s <= time_s; ++track.next)
        is_apart = is_apart || track.samples[track.next].arrival == Arrival::kApart;
      if (is_apart) teleported_.push_back(track.id);
      if (track.next == 0) continue;
      const Sample& before = track.samples[track.next - 1];
      if (before.time_s == time_s) {
        out.push_back({track.id, before.position_m});
      } else if (track.next < track.samples.size() && track.samples[track.next].arrival == Arrival::kMoved) {
        const Sample& after = track.samples[track.next];
        const double s = (time_s - before.time_s) / (after.time_s - before.time_s);
        out.push_back({track.id, before.position_m + s * (after.position_m - before.position_m)});
      }
    }
  }

  TimeSpan span_s() const override { return span_s_; }

 private:
  struct Track {
    std::uint32_t id;
    std::vector<Sample> samples;
    std::size_t next;  // the first sample after the time of the last `sample`
  };
  std::vector<Track> tracks_;
  TimeSpan span_s_;
};

}  // namespace

std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path) {
  ColliderRows rows(path);
  return std::make_unique<CsvColliders>(parse(rows));
}

}  // namespace vestige
