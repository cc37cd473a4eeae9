#include "traces/exchange/collider_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "traces/base/number_text.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr std::string_view kTimesRemedy = "each row is time_s,id,x,y,z: seconds, a whole number, metres";
constexpr std::string_view kFramesRemedy =
    "each row is frame,time_s,id,x,y,z,teleported: a whole number, seconds, a whole number, metres, 0 or 1";
constexpr std::string_view kAloneRemedy =
    "export poses and colliders of the same trace, or leave out the columns frame and teleported";

class ColliderCsv final : public TraceExport {
 public:
  ColliderCsv(const std::filesystem::path& path, Overwrite overwrite) : file_(path, overwrite) {
    file_.write(kColliderFramesHeader);
    file_.write("\n");
  }

  void write(const TraceFrame& frame) override {
    time_.clear();
    append_seconds(time_, frame.time_ns);
    teleported_.assign(frame.teleported.begin(), frame.teleported.end());
    std::ranges::sort(teleported_);
    for (const ColliderSample& collider : frame.colliders) {
      row_.clear();
      const bool teleported = std::ranges::binary_search(teleported_, collider.id);
      fmt::format_to(std::back_inserter(row_), "{},{},{},{},{},{},{}\n", frame.index, time_, collider.id,
                     collider.position_m.x, collider.position_m.y, collider.position_m.z, teleported ? 1 : 0);
      file_.write(row_);
    }
  }

  void commit() override { file_.commit(); }

 private:
  OutputFile file_;
  std::string time_;
  std::string row_;
  std::vector<std::uint32_t> teleported_;
};

}  // namespace

std::unique_ptr<TraceExport> make_collider_csv(const std::filesystem::path& path, Overwrite overwrite) {
  return std::make_unique<ColliderCsv>(path, overwrite);
}

ColliderRows::ColliderRows(const std::filesystem::path& path, const Convention& convention)
    : reader_(path), lines_(reader_, kTimesRemedy), convention_(convention) {
  const std::string header = fmt::format("{}", fmt::join(lines_.take_header(), ","));
  if (header == kColliderFramesHeader) {
    columns_ = ColliderColumns::kFrames;
    lines_.set_remedy(kFramesRemedy);
  } else if (header != kColliderTimesHeader) {
    throw lines_.error(fmt::format("the header is neither '{}' nor '{}'", kColliderTimesHeader, kColliderFramesHeader));
  }
}

bool ColliderRows::next(ColliderRow& row) {
  if (!lines_.next()) return false;
  glm::dvec3& position = row.sample.position_m;
  const bool has_frames = columns_ == ColliderColumns::kFrames;
  int teleported = 0;
  if (has_frames && !lines_.take(row.frame)) throw lines_.error("frame is not a whole number");
  if (!lines_.take(row.time_s)) throw lines_.error("time_s is not a number");
  if (!lines_.take(row.sample.id)) throw lines_.error("id is not a whole number from 0 to 4294967295");
  if (!lines_.take(position.x) || !lines_.take(position.y) || !lines_.take(position.z))
    throw lines_.error(has_frames ? "is not seven numbers" : "is not five numbers");
  if (has_frames && (!lines_.take(teleported) || (teleported != 0 && teleported != 1)))
    throw lines_.error("teleported is neither 0 nor 1");
  if (!lines_.at_end()) throw lines_.error(has_frames ? "is not seven numbers" : "is not five numbers");
  if (!std::isfinite(row.time_s) || !std::isfinite(position.x) || !std::isfinite(position.y) ||
      !std::isfinite(position.z))
    throw lines_.error("a number is not finite");
  if (!convention_.is_of_trace()) {
    position = convention_.position_m(position);
    row.time_s *= convention_.seconds_per_unit;
  }
  if (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) > trace_format::kFarthest_m)
    throw lines_.error("a coordinate is beyond 1e9 m");
  if (rows_ > 0 && row.time_s < last_time_s_)
    throw lines_.error(fmt::format("time runs backwards, from {} s to {} s", last_time_s_, row.time_s),
                       "sort the rows by time");
  if (has_frames && rows_ > 0 && row.frame < last_frame_)
    throw lines_.error(fmt::format("frame {} comes after frame {}", row.frame, last_frame_), "sort the rows");
  if (has_frames && rows_ > 0 && row.frame == last_frame_ && row.time_s != last_time_s_)
    throw lines_.error(fmt::format("frame {} is at {} s and at {} s", row.frame, last_time_s_, row.time_s));
  row.teleported = teleported == 1;
  last_time_s_ = row.time_s;
  last_frame_ = row.frame;
  ++rows_;
  return true;
}

void ColliderFrames::advance() {
  if (!rows_.next(ahead_ ? *ahead_ : ahead_.emplace())) ahead_.reset();
}

void ColliderFrames::fill(TraceFrame& frame) {
  frame.colliders.clear();
  frame.teleported.clear();
  ids_.clear();
  if (ahead_ && ahead_->frame < frame.index)
    throw rows_.error(fmt::format("frame {} has no pose", ahead_->frame), kAloneRemedy);
  for (; ahead_ && ahead_->frame == frame.index; advance()) {
    if (nanoseconds_of(ahead_->time_s) != frame.time_ns)
      throw rows_.error(fmt::format("frame {} is at {} s, but its pose has another time", frame.index, ahead_->time_s),
                        kAloneRemedy);
    if (!ids_.insert(ahead_->sample.id).second)
      throw rows_.error(fmt::format("collider {} has two positions in frame {}", ahead_->sample.id, frame.index),
                        "remove one of them");
    frame.colliders.push_back(ahead_->sample);
    if (ahead_->teleported) frame.teleported.push_back(ahead_->sample.id);
  }
}

void ColliderFrames::expect_end() const {
  if (ahead_) throw rows_.error(fmt::format("frame {} has no pose", ahead_->frame), kAloneRemedy);
}

}  // namespace vestige
