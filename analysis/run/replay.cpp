#include "analysis/run/replay.hpp"

#include <algorithm>
#include <chrono>
#include <span>

#include "analysis/base/clocks.hpp"
#include "detector/output/texture_hash.hpp"

namespace vestige {

namespace {

constexpr std::uint64_t kSkinningFrames = 5;

using Clock = std::chrono::steady_clock;

/// Chooses how many frames to detect together: enough that threads seldom wait for each other, and few enough that
/// progress is visible and an interrupt is noticed. A single thread takes frames one by one.
class BatchSize {
 public:
  explicit BatchSize(std::size_t threads) : alone_(threads == 1), size_(alone_ ? 1 : 4 * threads) {}

  std::size_t now() const { return size_; }

  void took(double batch_s) {
    if (alone_) return;
    if (batch_s < 2e-3) size_ = std::min<std::size_t>(2 * size_, 4096);
    if (batch_s > 0.1) size_ = std::max<std::size_t>(size_ / 2, 1);
  }

 private:
  bool alone_;
  std::size_t size_;
};

/// Turns the contacts of a CSV file back into rows, frame by frame.
class RecordedRows {
 public:
  RecordedRows(std::span<const RecordedContact> contacts, std::span<const std::uint32_t> collider_ids)
      : contacts_(contacts), collider_ids_(collider_ids) {}

  const ContactRow& row_of(std::uint64_t frame) {
    row_.assign(collider_ids_.size(), Contact());
    while (next_ < contacts_.size() && contacts_[next_].frame < frame) skip();
    for (; next_ < contacts_.size() && contacts_[next_].frame == frame; ++next_) {
      const RecordedContact& recorded = contacts_[next_];
      const auto place = std::ranges::lower_bound(collider_ids_, recorded.collider);
      if (place == collider_ids_.end() || *place != recorded.collider) {
        ++strangers_;
        continue;
      }
      Contact& contact = row_[static_cast<std::size_t>(place - collider_ids_.begin())];
      contact.triangle = recorded.triangle;
      contact.t = recorded.t;
      contact.actuator = recorded.actuator;
    }
    return row_;
  }

  /// Returns the number of contacts whose frame or collider the trace does not have. It includes contacts that were
  /// never asked for.
  std::uint64_t strangers() const { return strangers_ + (contacts_.size() - next_); }

 private:
  void skip() {
    ++strangers_;
    ++next_;
  }

  std::span<const RecordedContact> contacts_;
  std::span<const std::uint32_t> collider_ids_;
  std::size_t next_ = 0;
  std::uint64_t strangers_ = 0;
  ContactRow row_;
};

void look_up_anew(const ActuatorMap& map, ContactRow& row) {
  for (Contact& contact : row)
    if (contact.hit()) contact.actuator = map.at(contact.triangle, contact.texture_coordinate);
}

}  // namespace

ReplayResult replay(TraceReader& trace, const Avatar& avatar, std::size_t actuator_count, DetectorTeam& detectors,
                    const ReplayOutputs& outputs, const ReplayExpectation& expectation,
                    std::span<const MapChange> changes, const std::function<bool(double)>& progress) {
  const std::vector<std::uint32_t>& ids = trace.collider_ids();
  const std::uint64_t frame_count = trace.frame_count();
  const std::uint64_t skinning_step = std::max<std::uint64_t>(1, frame_count / kSkinningFrames);

  ReplayResult result;
  result.contacts_of_actuator.resize(actuator_count + 1);
  if (expectation.detectors != nullptr || expectation.contacts != nullptr) result.comparison.emplace();
  RecordedRows recorded(
      expectation.contacts != nullptr ? std::span(*expectation.contacts) : std::span<const RecordedContact>(), ids);
  FrameBuilder builder(avatar, ids, detectors.first().method());
  TextureHash hash;
  TraceFrame trace_frame;
  std::uint64_t frames_read = 0;
  double building_s = 0;
  double checking_s = 0;
  const auto read_batch = [&](FrameBatch& batch, std::size_t size) {
    batch.clear();
    while (batch.count < size) {
      const auto start = Clock::now();
      const bool more = trace.next(trace_frame);
      const auto read = Clock::now();
      result.reading_s += seconds(read - start);
      if (!more) return;
      const Frame& frame = builder.next(trace_frame);
      batch.add(frame);
      building_s += seconds(Clock::now() - read);
      if (frames_read % skinning_step == 0) {
        const auto check = Clock::now();
        result.skinning.add(avatar, trace_frame, frame, detectors.first());
        checking_s += seconds(Clock::now() - check);
      }
      ++frames_read;
    }
  };
  const ActuatorMap* changed_map = nullptr;
  std::size_t next_change = 0;
  const auto follow_changes = [&](double time_s) {
    for (; next_change < changes.size() && changes[next_change].time_s <= time_s; ++next_change) {
      changed_map = &changes[next_change].map;
      if (outputs.drive != nullptr) outputs.drive->law().change_layout(changes[next_change].layout);
    }
  };
  const auto take = [&](const Frame& frame, const ContactRow& row, const DetectorWork& work) {
    result.work += work;
    for (const Contact& contact : row) {
      if (!contact.hit()) continue;
      ++result.contacts;
      ++result.contacts_of_actuator[contact.actuator];
    }
    hash.add(row);
    if (outputs.contacts != nullptr) outputs.contacts->write(frame, row, ids);
    if (outputs.textures != nullptr) outputs.textures->add(frame, row);
    if (outputs.timeline != nullptr) outputs.timeline->write(outputs.drive->next(frame.time_s, row));
    if (expectation.contacts != nullptr) result.comparison->add(row, recorded.row_of(frame.index));
    ++result.frames;
    return progress(static_cast<double>(result.frames) / static_cast<double>(frame_count));
  };

  trace.rewind();
  BatchSize size(detectors.threads());
  FrameBatch batch;
  FrameBatch next_batch;
  FrameBatch expected;
  read_batch(batch, size.now());
  while (batch.count != 0 && !result.interrupted) {
    const auto start = Clock::now();
    const double checked_before_s = checking_s;
    detectors.start(batch);
    read_batch(next_batch, size.now());
    const auto finish = Clock::now();
    detectors.finish();
    const auto end = Clock::now();
    const bool alone = detectors.threads() == 1;
    const double spent_s = alone ? seconds(end - finish) : seconds(end - start) - (checking_s - checked_before_s);
    result.detection_s += spent_s;
    size.took(spent_s);
    if (expectation.detectors != nullptr) {
      expected = batch;
      expectation.detectors->start(expected);
      expectation.detectors->finish();
    }
    for (std::size_t i = 0; i < batch.count && !result.interrupted; ++i) {
      follow_changes(batch.frames[i].time_s);
      if (changed_map != nullptr) look_up_anew(*changed_map, batch.rows[i]);
      if (changed_map != nullptr && expectation.detectors != nullptr) look_up_anew(*changed_map, expected.rows[i]);
      if (expectation.detectors != nullptr) result.comparison->add(batch.rows[i], expected.rows[i]);
      result.interrupted = !take(batch.frames[i], batch.rows[i], batch.work[i]);
    }
    std::swap(batch, next_batch);
  }
  if (detectors.threads() == 1) result.detection_s += building_s;  // with several threads, their time includes it
  if (expectation.contacts != nullptr && !result.interrupted) {
    result.comparison->missing += recorded.strangers();
    result.comparison->expected += recorded.strangers();
  }
  result.texture_hash = hash.hex();
  result.origin_changes = builder.origin_changes();
  result.map_changes = next_change;
  result.non_finite_frames = builder.non_finite_frames();
  result.non_finite_segments = builder.non_finite_segments();
  result.first_non_finite = builder.first_non_finite();
  return result;
}

}  // namespace vestige
