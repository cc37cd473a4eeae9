#include "traces/exchange/collider_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "traces/base/number_text.hpp"
#include "traces/exchange/trace_export.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr std::string_view kAloneRemedy =
    "export poses and colliders of the same trace, or leave out the columns frame and teleported";

constexpr std::string_view kPlainRemedy = "each row is time_s,id,x,y,z: seconds, a whole number, metres";

std::string remedy_of(ColliderColumns columns, ColliderShape shape, Owners owners) {
  const bool has_frames = columns == ColliderColumns::kFrames;
  return fmt::format("each row is {}: {}seconds, a whole number, metres{}{}", collider_header(columns, shape, owners),
                     has_frames ? "a whole number, " : "",
                     owners == Owners::kPeople ? ", the number of a person or 0" : "", has_frames ? ", 0 or 1" : "");
}

class ColliderCsv final : public TraceExport {
 public:
  ColliderCsv(const std::filesystem::path& path, Overwrite overwrite, ColliderShape shape, Owners owners)
      : file_(path, overwrite), shape_(shape), owners_(owners) {
    file_.write(collider_header(ColliderColumns::kFrames, shape, owners));
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
      fmt::format_to(std::back_inserter(row_), "{},{},{},{},{},{},", frame.index, time_, collider.id,
                     collider.position_m.x, collider.position_m.y, collider.position_m.z);
      if (shape_ == ColliderShape::kSpheres) fmt::format_to(std::back_inserter(row_), "{},", collider.radius_m);
      if (owners_ == Owners::kPeople) fmt::format_to(std::back_inserter(row_), "{},", collider.owner);
      row_ += teleported ? "1\n" : "0\n";
      file_.write(row_);
    }
  }

  void commit() override { file_.commit(); }

 private:
  OutputFile file_;
  ColliderShape shape_;
  Owners owners_;
  std::string time_;
  std::string row_;
  std::vector<std::uint32_t> teleported_;
};

}  // namespace

std::string collider_header(ColliderColumns columns, ColliderShape shape, Owners owners) {
  const bool has_frames = columns == ColliderColumns::kFrames;
  return fmt::format("{}time_s,id,x,y,z{}{}{}", has_frames ? "frame," : "",
                     shape == ColliderShape::kSpheres ? ",radius_m" : "", owners == Owners::kPeople ? ",owner" : "",
                     has_frames ? ",teleported" : "");
}

std::unique_ptr<TraceExport> make_collider_csv(const std::filesystem::path& path, Overwrite overwrite,
                                               ColliderShape shape, Owners owners) {
  return std::make_unique<ColliderCsv>(path, overwrite, shape, owners);
}

ColliderRows::ColliderRows(const std::filesystem::path& path, const Convention& convention, std::size_t people)
    : reader_(path), lines_(reader_, kPlainRemedy), convention_(convention), people_(people) {
  take_header();
}

void ColliderRows::take_header() {
  const std::string header = fmt::format("{}", fmt::join(lines_.take_header(), ","));
  for (const ColliderColumns columns : {ColliderColumns::kTimes, ColliderColumns::kFrames})
    for (const ColliderShape shape : {ColliderShape::kPoints, ColliderShape::kSpheres})
      for (const Owners owners : {Owners::kNone, Owners::kPeople}) {
        if (header != collider_header(columns, shape, owners)) continue;
        columns_ = columns;
        shape_ = shape;
        owners_ = owners;
        remedy_ = remedy_of(columns, shape, owners);
        lines_.set_remedy(remedy_);
        return;
      }
  throw lines_.error(
      "the header is neither 'time_s,id,x,y,z' nor 'frame,time_s,id,x,y,z,teleported', with or without radius_m and "
      "owner behind z");
}

void ColliderRows::take_fields(ColliderRow& row) {
  glm::dvec3& position = row.sample.position_m;
  const bool has_frames = columns_ == ColliderColumns::kFrames;
  const bool has_radii = shape_ == ColliderShape::kSpheres;
  const bool has_owners = owners_ == Owners::kPeople;
  int teleported = 0;
  double radius_m = 0;
  const auto wrong_count = [&] {
    constexpr std::array kCounts = {"five", "six", "seven", "eight", "nine"};
    const std::size_t more = (has_frames ? 2U : 0U) + (has_radii ? 1U : 0U) + (has_owners ? 1U : 0U);
    return lines_.error(fmt::format("is not {} numbers", kCounts.at(more)));
  };
  if (has_frames && !lines_.take(row.frame)) throw lines_.error("frame is not a whole number");
  if (!lines_.take(row.time_s)) throw lines_.error("time_s is not a number");
  if (!lines_.take(row.sample.id)) throw lines_.error("id is not a whole number from 0 to 4294967295");
  if (!lines_.take(position.x) || !lines_.take(position.y) || !lines_.take(position.z)) throw wrong_count();
  if (has_radii && !lines_.take(radius_m)) throw lines_.error("radius_m is not a number");
  if (has_owners && !lines_.take(row.sample.owner)) throw lines_.error("owner is not a whole number from 0 to 65535");
  if (has_frames && (!lines_.take(teleported) || (teleported != 0 && teleported != 1)))
    throw lines_.error("teleported is neither 0 nor 1");
  if (!lines_.at_end()) throw wrong_count();
  if (!std::isfinite(row.time_s) || !std::isfinite(position.x) || !std::isfinite(position.y) ||
      !std::isfinite(position.z))
    throw lines_.error("a number is not finite");
  if (const std::string_view fault = radius_fault(radius_m); !fault.empty())
    throw lines_.error(fmt::format("radius_m {}", fault), "a radius is a number of metres from 0 to 10");
  row.sample.radius_m = static_cast<float>(radius_m);
  row.teleported = teleported == 1;
}

void ColliderRows::check_order(const ColliderRow& row) const {
  const bool has_frames = columns_ == ColliderColumns::kFrames;
  if (rows_ == 0) return;
  if (row.time_s < last_time_s_)
    throw lines_.error(fmt::format("time runs backwards, from {} s to {} s", last_time_s_, row.time_s),
                       "sort the rows by time");
  if (has_frames && row.frame < last_frame_)
    throw lines_.error(fmt::format("frame {} comes after frame {}", row.frame, last_frame_), "sort the rows");
  if (has_frames && row.frame == last_frame_ && row.time_s != last_time_s_)
    throw lines_.error(fmt::format("frame {} is at {} s and at {} s", row.frame, last_time_s_, row.time_s));
}

void ColliderRows::check_owner(const ColliderSample& sample) {
  if (owners_ == Owners::kNone) return;
  if (const auto fault = owner_fault({&sample, 1}, people_))
    throw lines_.error(*fault, "an owner is 0 for nobody, or the number of a person");
  const auto [known, is_new] = owner_of_.try_emplace(sample.id, sample.owner);
  if (known->second != sample.owner)
    throw lines_.error(fmt::format("collider {} belongs to {}, and before it belonged to {}", sample.id,
                                   in_words(sample.owner), in_words(known->second)),
                       "give each collider one owner");
}

bool ColliderRows::next(ColliderRow& row) {
  if (!lines_.next()) return false;
  take_fields(row);
  glm::dvec3& position = row.sample.position_m;
  if (!convention_.is_of_trace()) {
    position = convention_.position_m(position);
    row.time_s *= convention_.seconds_per_unit;
  }
  if (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) > trace_format::kFarthest_m)
    throw lines_.error("a coordinate is beyond 1e9 m");
  check_order(row);
  check_owner(row.sample);
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
