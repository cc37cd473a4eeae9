#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "traces/colliders.hpp"
#include "traces/csv.hpp"
#include "traces/error.hpp"
#include "traces/input_file.hpp"

namespace vestige {

namespace {

constexpr std::string_view kHeader = "time_s,id,x,y,z";
constexpr std::string_view kRemedy = "each row is time_s,id,x,y,z: seconds, a whole number, metres";

constexpr double kFarthest_m = 1e9;  // an astronomical unit is a mistake

struct Sample {
  double time_s = 0;
  glm::dvec3 position_m = glm::dvec3(0);
};

using Samples = std::map<std::uint32_t, std::vector<Sample>>;

Samples parse(std::string_view text, const std::string& name) {
  Samples samples;
  CsvLines lines(text, name, kHeader, kRemedy);
  double latest_s = 0;
  while (lines.next()) {
    Sample sample;
    std::uint32_t id = 0;
    glm::dvec3& position = sample.position_m;
    if (!lines.take(sample.time_s)) throw lines.error("time_s is no number");
    if (!lines.take(id)) throw lines.error("id is no whole number from 0 to 4294967295");
    if (!lines.take(position.x) || !lines.take(position.y) || !lines.take(position.z) || !lines.at_end())
      throw lines.error("is not five numbers");
    if (!std::isfinite(sample.time_s) || !std::isfinite(position.x) || !std::isfinite(position.y) ||
        !std::isfinite(position.z))
      throw lines.error("a number is not finite");
    if (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) > kFarthest_m)
      throw lines.error("a position is farther away than 1e9 m");
    if (!samples.empty() && sample.time_s < latest_s)
      throw lines.error(fmt::format("time runs backwards, from {} s to {} s", latest_s, sample.time_s),
                        "sort the rows by time");
    latest_s = sample.time_s;
    auto& of_collider = samples[id];
    if (!of_collider.empty() && of_collider.back().time_s == sample.time_s)
      throw lines.error(fmt::format("collider {} has two positions at {} s", id, sample.time_s), "remove one of them");
    of_collider.push_back(sample);
  }
  if (samples.empty()) throw Error(name, "holds no sample", kRemedy);
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
    for (Track& track : tracks_) {
      while (track.next < track.samples.size() && track.samples[track.next].time_s <= time_s) ++track.next;
      if (track.next == 0) continue;
      const Sample& before = track.samples[track.next - 1];
      if (before.time_s == time_s) {
        out.push_back({track.id, before.position_m});
      } else if (track.next < track.samples.size()) {
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
    std::size_t next;  // the first sample later than the last time asked for
  };
  std::vector<Track> tracks_;
  TimeSpan span_s_;
};

}  // namespace

std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path) {
  return std::make_unique<CsvColliders>(parse(read_text_file(path), path.string()));
}

}  // namespace vestige
