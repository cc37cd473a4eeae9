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

/// One run through a trace. While the team detects in one batch of frames, the next one is read.
class Replay {
 public:
  Replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan)
      : trace_(trace),
        detectors_(detectors),
        plan_(plan),
        frame_count_(trace.frame_count()),
        skinning_step_(std::max<std::uint64_t>(1, frame_count_ / kSkinningFrames)),
        recorded_(plan.expectation.contacts != nullptr ? std::span(*plan.expectation.contacts)
                                                       : std::span<const RecordedContact>(),
                  trace.collider_ids()),
        builder_(plan.avatar, trace.collider_ids(), detectors.first().method()) {
    result_.contacts_of_actuator.resize(plan.actuator_count + 1);
    if (plan.expectation.detectors != nullptr || plan.expectation.contacts != nullptr) result_.comparison.emplace();
  }

  ReplayResult run(const std::function<bool(double)>& progress) {
    trace_.rewind();
    BatchSize size(detectors_.threads());
    FrameBatch batch;
    FrameBatch next_batch;
    read(batch, size.now());
    while (batch.count != 0 && !result_.interrupted) {
      size.took(detect(batch, next_batch, size.now()));
      take(batch, progress);
      std::swap(batch, next_batch);
    }
    finish();
    return std::move(result_);
  }

 private:
  void read(FrameBatch& batch, std::size_t size) {
    batch.clear();
    while (batch.count < size) {
      const auto start = Clock::now();
      const bool more = trace_.next(trace_frame_);
      const auto read = Clock::now();
      result_.reading_s += seconds(read - start);
      if (!more) return;
      const DetectorFrame& frame = builder_.next(trace_frame_);
      batch.add(frame);
      building_s_ += seconds(Clock::now() - read);
      if (frames_read_ % skinning_step_ == 0) {
        const auto check = Clock::now();
        result_.skinning.add(plan_.avatar, trace_frame_, frame, detectors_.first());
        checking_s_ += seconds(Clock::now() - check);
      }
      ++frames_read_;
    }
  }

  /// Detects in `batch` and reads `next_batch` beside it. Returns the seconds that detection took.
  double detect(FrameBatch& batch, FrameBatch& next_batch, std::size_t next_size) {
    const auto start = Clock::now();
    const double checked_before_s = checking_s_;
    detectors_.start(batch);
    read(next_batch, next_size);
    const auto finish = Clock::now();
    detectors_.finish();
    const auto end = Clock::now();
    const double spent_s = is_alone() ? seconds(end - finish) : seconds(end - start) - (checking_s_ - checked_before_s);
    result_.detection_s += spent_s;
    if (plan_.expectation.detectors != nullptr) {
      expected_ = batch;
      plan_.expectation.detectors->start(expected_);
      plan_.expectation.detectors->finish();
    }
    return spent_s;
  }

  void take(FrameBatch& batch, const std::function<bool(double)>& progress) {
    for (std::size_t i = 0; i < batch.count && !result_.interrupted; ++i) {
      follow_map_changes(batch.frames[i].time_s);
      if (changed_map_ != nullptr) look_up_anew(*changed_map_, batch.rows[i]);
      if (plan_.expectation.detectors != nullptr) {
        if (changed_map_ != nullptr) look_up_anew(*changed_map_, expected_.rows[i]);
        result_.comparison->add(batch.rows[i], expected_.rows[i]);
      }
      take(batch.frames[i], batch.rows[i], batch.work[i]);
      result_.interrupted = !progress(static_cast<double>(result_.frames) / static_cast<double>(frame_count_));
    }
  }

  void take(const DetectorFrame& frame, const ContactRow& row, const DetectorWork& work) {
    result_.work += work;
    for (const Contact& contact : row) {
      if (!contact.hit()) continue;
      ++result_.contacts;
      ++result_.contacts_of_actuator[contact.actuator];
    }
    hash_.add(row);
    const ReplayOutputs& outputs = plan_.outputs;
    if (outputs.contacts != nullptr) outputs.contacts->write(frame, row, trace_.collider_ids());
    if (outputs.textures != nullptr) outputs.textures->add(frame, row);
    if (outputs.timeline != nullptr) {
      const ActuatorFrame& driven = outputs.drive->next(frame.time_s, row, &frame);
      result_.any_vibrates |= std::ranges::any_of(driven.duty, [](std::uint8_t duty) { return duty != 0; });
      outputs.timeline->write(driven);
    }
    if (plan_.expectation.contacts != nullptr) result_.comparison->add(row, recorded_.row_of(frame.index));
    ++result_.frames;
  }

  void follow_map_changes(double time_s) {
    for (; result_.map_changes < plan_.changes.size(); ++result_.map_changes) {
      const MapChange& change = plan_.changes[result_.map_changes];
      if (change.time_s > time_s) return;
      changed_map_ = &change.map;
      if (plan_.outputs.drive != nullptr) plan_.outputs.drive->law().change_map(change.map.firing, change.layout);
    }
  }

  void finish() {
    if (is_alone()) result_.detection_s += building_s_;  // several threads had it within their time
    if (plan_.expectation.contacts != nullptr && !result_.interrupted) {
      result_.comparison->missing += recorded_.strangers();
      result_.comparison->expected += recorded_.strangers();
    }
    result_.texture_hash = hash_.hex();
    result_.origin_changes = builder_.origin_changes();
    result_.non_finite_frames = builder_.non_finite_frames();
    result_.non_finite_segments = builder_.non_finite_segments();
    result_.first_non_finite = builder_.first_non_finite();
  }

  bool is_alone() const { return detectors_.threads() == 1; }

  TraceReader& trace_;
  DetectorTeam& detectors_;
  const ReplayPlan& plan_;
  std::uint64_t frame_count_;
  std::uint64_t skinning_step_;  ///< of frames whose skinning is checked
  RecordedRows recorded_;
  FrameBuilder builder_;
  TraceFrame trace_frame_;
  std::uint64_t frames_read_ = 0;
  FrameBatch expected_;
  TextureHash hash_;
  const ActuatorMap* changed_map_ = nullptr;
  double building_s_ = 0;
  double checking_s_ = 0;
  ReplayResult result_;
};

}  // namespace

ReplayResult replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan,
                    const std::function<bool(double)>& progress) {
  return Replay(trace, detectors, plan).run(progress);
}

}  // namespace vestige
