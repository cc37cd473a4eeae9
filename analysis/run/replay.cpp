#include "analysis/run/replay.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

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

/// Turns the contacts of a file back into rows, frame by frame and person by person.
class RecordedRows {
 public:
  /// `contacts` are ordered by frame and avatar.
  RecordedRows(std::span<const RecordedContact> contacts, std::span<const std::uint32_t> collider_ids)
      : contacts_(contacts), collider_ids_(collider_ids) {}

  /// Frames must ascend, and in a frame the avatars, which count from 1. The reference is valid until the next call.
  const ContactRow& row_of(std::uint64_t frame, std::uint16_t avatar) {
    const auto place_of = [](const RecordedContact& contact) { return std::pair(contact.frame, contact.avatar); };
    const std::pair wanted(frame, avatar);
    row_.clear(collider_ids_.size());
    for (; next_ < contacts_.size() && place_of(contacts_[next_]) <= wanted; ++next_) {
      const RecordedContact& recorded = contacts_[next_];
      const auto place = std::ranges::lower_bound(collider_ids_, recorded.collider);
      if (place_of(recorded) < wanted || place == collider_ids_.end() || *place != recorded.collider) {
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

  /// Returns the number of contacts whose frame, avatar or collider the trace does not have. It includes contacts that
  /// were never asked for.
  std::uint64_t strangers() const { return strangers_ + (contacts_.size() - next_); }

 private:
  std::span<const RecordedContact> contacts_;
  std::span<const std::uint32_t> collider_ids_;
  std::size_t next_ = 0;
  std::uint64_t strangers_ = 0;
  ContactRow row_;
};

/// One run through a trace. While the team detects in one batch of frames, the next one is read.
class Replay {
 public:
  Replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan)
      : trace_(trace),
        detectors_(detectors),
        plan_(plan),
        frame_count_(trace.frame_count()),
        skinning_step_(std::max<std::uint64_t>(1, frame_count_ / kSkinningFrames)),
        colliders_(trace.collider_ids()) {
    people_.reserve(plan.people.size());
    for (std::size_t person = 0; person < plan.people.size(); ++person)
      people_.emplace_back(plan.people[person], person, detectors.first(person));
    if (plan.expectation.contacts != nullptr) recorded_.emplace(*plan.expectation.contacts, trace.collider_ids());
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
  /// Reads so many frames of the trace, each of which is a frame for every person.
  void read(FrameBatch& batch, std::size_t size) {
    batch.clear();
    while (batch.count < size * people_.size()) {
      const auto start = Clock::now();
      const bool more = trace_.next(trace_frame_);
      const auto read = Clock::now();
      result_.reading_s += seconds(read - start);
      if (!more) return;
      colliders_.next(trace_frame_);
      for (PersonReplay& person : people_) batch.add(person.build(trace_frame_, colliders_));
      building_s_ += seconds(Clock::now() - read);
      if (frames_read_ % skinning_step_ == 0) check_skinning(batch);
      ++frames_read_;
    }
  }

  /// Checks how the people of the frame that was read last are skinned.
  void check_skinning(const FrameBatch& batch) {
    const auto start = Clock::now();
    for (std::size_t person = 0; person < people_.size(); ++person)
      people_[person].check_skinning(trace_frame_, batch.frames[batch.count - people_.size() + person],
                                     detectors_.first(person));
    checking_s_ += seconds(Clock::now() - start);
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
    for (std::size_t i = 0; i < batch.count && !result_.interrupted; i += people_.size()) {
      for (std::size_t person = 0; person < people_.size(); ++person) take(person, batch, i + person);
      ++result_.frames;
      result_.interrupted = !progress(static_cast<double>(result_.frames) / static_cast<double>(frame_count_));
    }
  }

  /// Takes the row of batch.frames[i], which is a frame of this person.
  void take(std::size_t person, FrameBatch& batch, std::size_t i) {
    const DetectorFrame& frame = batch.frames[i];
    ContactRow& row = batch.rows[i];
    ContactRow* const other = plan_.expectation.detectors != nullptr ? &expected_.rows[i] : nullptr;
    const auto avatar = static_cast<std::uint16_t>(person + 1);
    result_.work += batch.work[i];
    people_[person].take(frame, row, other);
    if (other != nullptr) result_.comparison->add(row, *other);
    if (recorded_) result_.comparison->add(row, recorded_->row_of(frame.index, avatar));
    if (plan_.contacts != nullptr) plan_.contacts->write(avatar, frame, row, trace_.collider_ids());
    if (plan_.textures != nullptr) plan_.textures->add(person, frame, row);
  }

  void finish() {
    if (is_alone()) result_.detection_s += building_s_;  // several threads had it within their time
    std::vector<std::string> hashes;
    for (PersonReplay& person : people_) {
      const PersonResult& found = result_.people.emplace_back(person.finish());
      hashes.push_back(found.texture_hash);
      result_.contacts += found.contacts;
      result_.origin_changes += found.origin_changes;
      result_.non_finite_frames += found.non_finite_frames;
      result_.non_finite_segments += found.non_finite_segments;
      if (found.first_non_finite)
        result_.first_non_finite =
            std::min(*found.first_non_finite, result_.first_non_finite.value_or(*found.first_non_finite));
    }
    result_.texture_hash = texture_hash_of(hashes);
    if (!recorded_ || result_.interrupted) return;
    result_.comparison->missing += recorded_->strangers();
    result_.comparison->expected += recorded_->strangers();
  }

  bool is_alone() const { return detectors_.threads() == 1; }

  TraceReader& trace_;
  DetectorTeam& detectors_;
  const ReplayPlan& plan_;
  std::uint64_t frame_count_;
  std::uint64_t skinning_step_;  ///< of frames whose skinning is checked
  ColliderMoves colliders_;
  std::vector<PersonReplay> people_;
  std::optional<RecordedRows> recorded_;
  TraceFrame trace_frame_;
  std::uint64_t frames_read_ = 0;
  FrameBatch expected_;
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
