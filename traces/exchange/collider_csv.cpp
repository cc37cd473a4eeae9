#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
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
  float radius_m = 0;
  Arrival arrival = Arrival::kMoved;
};

struct Recorded {
  std::uint16_t owner = kNobody;
  std::vector<Sample> samples;
};

/// By id.
using Samples = std::map<std::uint32_t, Recorded>;

Samples parse(ColliderRows& rows) {
  Samples samples;
  std::map<std::uint32_t, std::uint64_t> last_frame;
  ColliderRow row;
  while (rows.next(row)) {
    Recorded& recorded = samples[row.sample.id];
    recorded.owner = row.sample.owner;
    auto& of_collider = recorded.samples;
    if (!of_collider.empty() && of_collider.back().time_s == row.time_s)
      throw rows.error(fmt::format("collider {} has two positions at {} s", row.sample.id, row.time_s),
                       "give each collider an id of its own, or remove one of the rows");
    Sample sample = {row.time_s, row.sample.position_m, row.sample.radius_m, Arrival::kMoved};
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

/// A median step longer than this is likely one in milliseconds.
constexpr double kLongStep_s = 0.5;
/// In metres a second. Nothing that touches people is so fast.
constexpr double kFastest = 100;

/// How a file's samples follow each other.
struct Steps {
  double median_s = 0;    ///< 0 if no collider has two samples
  double fast_share = 0;  ///< of the steps that are faster than `kFastest`
};

Steps steps_of(const Samples& samples) {
  std::vector<double> steps_s;
  std::size_t fast = 0;
  for (const auto& [id, recorded] : samples) {
    const std::vector<Sample>& of_collider = recorded.samples;
    for (std::size_t i = 1; i < of_collider.size(); ++i) {
      if (of_collider[i].arrival == Arrival::kApart) continue;
      steps_s.push_back(of_collider[i].time_s - of_collider[i - 1].time_s);
      if (glm::distance(of_collider[i].position_m, of_collider[i - 1].position_m) > kFastest * steps_s.back()) ++fast;
    }
  }
  if (steps_s.empty()) return {};
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::ranges::nth_element(steps_s, middle);
  return {*middle, static_cast<double>(fast) / static_cast<double>(steps_s.size())};
}

class CsvColliders final : public ColliderSource {
 public:
  CsvColliders(const Samples& samples, const ColliderRows& rows, const Convention& convention)
      : steps_(steps_of(samples)), shape_(rows.shape()), owners_(rows.owners()), convention_(convention) {
    span_s_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& [id, recorded] : samples) {
      tracks_.push_back({id, recorded, 0});
      span_s_.first_s = std::min(span_s_.first_s, recorded.samples.front().time_s);
      span_s_.last_s = std::max(span_s_.last_s, recorded.samples.back().time_s);
    }
  }

  void sample(double exact_s, std::vector<ColliderSample>& out) override {
    const double time_s = std::round(exact_s * 1e9) / 1e9;  // as traces, and so exported files, have it
    out.clear();
    teleported_.clear();
    for (Track& track : tracks_) {
      const std::vector<Sample>& samples = track.recorded.samples;
      const std::uint16_t owner = track.recorded.owner;
      bool is_apart = false;
      for (; track.next < samples.size() && samples[track.next].time_s <= time_s; ++track.next)
        is_apart = is_apart || samples[track.next].arrival == Arrival::kApart;
      if (is_apart) teleported_.push_back(track.id);
      if (track.next == 0) continue;
      const Sample& before = samples[track.next - 1];
      if (before.time_s == time_s) {
        out.push_back({track.id, before.position_m, before.radius_m, owner});
      } else if (track.next < samples.size() && samples[track.next].arrival == Arrival::kMoved) {
        const Sample& after = samples[track.next];
        const double s = (time_s - before.time_s) / (after.time_s - before.time_s);
        const double grown_m = s * (double{after.radius_m} - double{before.radius_m});
        out.push_back({track.id, before.position_m + s * (after.position_m - before.position_m),
                       static_cast<float>(double{before.radius_m} + grown_m), owner});
      }
    }
  }

  ColliderShape shape() const override { return shape_; }
  Owners owners() const override { return owners_; }
  std::optional<std::uint32_t> largest_id() const override { return tracks_.back().id; }
  TimeSpan span_s() const override { return span_s_; }
  double median_step_s() const override { return steps_.median_s; }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> doubts;
    if (steps_.median_s > kLongStep_s && convention_.seconds_per_unit == 1)
      doubts.push_back(
          fmt::format("the samples of a collider are {:.4g} s apart (median); if these are milliseconds: "
                      "--time-unit ms",
                      steps_.median_s));
    if (steps_.fast_share > 0.5)
      doubts.push_back(
          fmt::format("{:.0f} % of all steps are faster than {:g} m/s; check the units (--collider-unit, "
                      "--time-unit), and that each collider has its own id",
                      100 * steps_.fast_share, kFastest));
    return doubts;
  }

 private:
  struct Track {
    std::uint32_t id;
    Recorded recorded;
    std::size_t next;  // the first sample after the time of the last `sample`
  };
  Steps steps_;
  ColliderShape shape_;
  Owners owners_;
  Convention convention_;
  std::vector<Track> tracks_;
  TimeSpan span_s_;
};

}  // namespace

std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path, const Convention& convention,
                                                  std::size_t people) {
  ColliderRows rows(path, convention, people);
  const Samples samples = parse(rows);
  return std::make_unique<CsvColliders>(samples, rows, convention);
}

}  // namespace vestige
