#include "analysis/run/replay.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "analysis/base/clocks.hpp"
#include "detector/output/texture_hash.hpp"

namespace vestige {

namespace {

constexpr std::uint64_t kSkinningFrames = 5;

using Clock = std::chrono::steady_clock;

/// Chooses how many runs of frames to detect together: enough that threads seldom wait for each other, and few enough
/// that progress is visible, an interrupt is noticed, and they fit into memory. A run that is divided among threads
/// would take other work. So the calling thread detects alone, in frames that count as runs, if a run is too large for
/// memory, or if slower detectors verify each frame.
class BatchSize {
 public:
  /// `columns` are those of a frame, of all people together.
  BatchSize(const DetectorTeam& detectors, std::size_t columns, bool verifies) {
    const std::size_t threads = detectors.threads();
    const std::uint64_t run_length = detectors.first().run_length();
    const std::size_t frame_bytes = std::max<std::size_t>(columns, 1) * (sizeof(Segment) + sizeof(Contact));
    const bool may_divide = run_length == 1 || (!verifies && run_length * frame_bytes <= kMostRunBytes);
    is_alone_ = threads == 1 || !may_divide;
    run_length_ = is_alone_ ? 1 : run_length;
    if (threads == 1 || (is_alone_ && !verifies)) return;  // one frame at a time
    const std::size_t fit = std::min(kMostFrames, kMostBytes / frame_bytes);
    most_ = std::max<std::size_t>(fit / run_length_, 1);
    least_ = run_length_ == 1 ? 1 : std::min(threads, most_);
    runs_ = run_length_ == 1 ? std::min(4 * threads, most_) : least_;
  }

  /// Whether only the calling thread detects.
  bool is_alone() const { return is_alone_; }
  std::size_t runs() const { return runs_; }
  /// Which run a frame belongs to.
  std::uint64_t run_of(const TraceFrame& frame) const { return frame.index / run_length_; }

  void took(double batch_s) {
    if (batch_s < 2e-3) runs_ = std::min(2 * runs_, most_);
    if (batch_s > 0.1) runs_ = std::max(runs_ / 2, least_);
  }

 private:
  static constexpr std::size_t kMostFrames = 4096;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;      ///< of a batch of several runs; four exist
  static constexpr std::size_t kMostRunBytes = std::size_t{256} << 20;  ///< of a run

  bool is_alone_ = true;
  std::uint64_t run_length_ = 1;
  std::size_t least_ = 1;
  std::size_t most_ = 1;
  std::size_t runs_ = 1;
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

/// One pass through a trace. While the team detects in one batch of frames, one of its threads takes the results of the
/// batch before, and the calling thread reads the next one.
class Replay {
 public:
  Replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan)
      : trace_(trace),
        detectors_(detectors),
        plan_(plan),
        frame_count_(trace.frame_count()),
        skinning_step_(std::max<std::uint64_t>(1, frame_count_ / kSkinningFrames)),
        colliders_(trace.collider_ids()),
        size_(detectors, plan.people.size() * trace.collider_ids().size(), plan.expectation.detectors != nullptr) {
    people_.reserve(plan.people.size());
    for (std::size_t person = 0; person < plan.people.size(); ++person)
      people_.emplace_back(plan.people[person], person, detectors.first(person));
    if (plan.expectation.contacts != nullptr) recorded_.emplace(*plan.expectation.contacts, trace.collider_ids());
    if (plan.expectation.detectors != nullptr || plan.expectation.contacts != nullptr) result_.comparison.emplace();
  }

  ReplayResult run(const std::function<bool(double)>& progress) {
    trace_.rewind();
    read();
    while (next_.count != 0 && !result_.interrupted) {
      std::swap(before_, batch_);
      std::swap(batch_, next_);
      size_.took(detect(progress));
    }
    std::swap(before_, batch_);
    take_before(progress);
    if (read_failure_ && !result_.interrupted) std::rethrow_exception(read_failure_);
    finish();
    return std::move(result_);
  }

 private:
  /// Reads the next batch of the trace. Each of its frames is one for every person. What it throws is kept until all
  /// frames before have been taken.
  void read() {
    next_.clear();
    next_runs_ = 0;
    if (read_failure_) return;
    try {
      while (read_frame()) add_frame();
    } catch (...) {
      read_failure_ = std::current_exception();
    }
  }

  /// Reads a frame of the trace. Returns false at the end, or if the frame belongs to a later batch.
  bool read_frame() {
    if (!holds_frame_) {
      const auto start = Clock::now();
      holds_frame_ = trace_.next(trace_frame_);
      result_.reading_s += seconds(Clock::now() - start);
    }
    if (!holds_frame_) return false;
    const std::uint64_t run = size_.run_of(trace_frame_);
    if (next_.count != 0 && run == last_run_) return true;
    if (next_runs_ == size_.runs()) return false;
    ++next_runs_;
    last_run_ = run;
    return true;
  }

  void add_frame() {
    const auto start = Clock::now();
    holds_frame_ = false;
    colliders_.next(trace_frame_);
    for (PersonReplay& person : people_) next_.add(person.build(trace_frame_, colliders_));
    building_s_ += seconds(Clock::now() - start);
    if (frames_read_ % skinning_step_ == 0) check_skinning();
    ++frames_read_;
  }

  /// Checks how the people of the frame that was read last are skinned.
  void check_skinning() {
    const auto start = Clock::now();
    for (std::size_t person = 0; person < people_.size(); ++person)
      people_[person].check_skinning(trace_frame_, next_.frames[next_.count - people_.size() + person],
                                     detectors_.first(person));
    checking_s_ += seconds(Clock::now() - start);
  }

  /// Detects in the batch, takes the one before and reads the next one. Returns the seconds that all of it took.
  double detect(const std::function<bool(double)>& progress) {
    const auto start = Clock::now();
    if (size_.is_alone()) {
      take_before(progress);
      read();
      const auto read = Clock::now();
      detectors_.detect_alone(batch_);
      result_.detection_s += seconds(Clock::now() - read);
    } else {
      const double checked_before_s = checking_s_;
      detectors_.start(batch_, [&] { take_before(progress); });
      read();
      detectors_.finish();
      result_.detection_s += seconds(Clock::now() - start) - (checking_s_ - checked_before_s);
    }
    if (plan_.expectation.detectors != nullptr && !result_.interrupted) {
      expected_ = batch_;
      plan_.expectation.detectors->start(expected_);
      plan_.expectation.detectors->finish();
    }
    return seconds(Clock::now() - start);
  }

  void take_before(const std::function<bool(double)>& progress) {
    for (std::size_t i = 0; i < before_.count && !result_.interrupted; i += people_.size()) {
      for (std::size_t person = 0; person < people_.size(); ++person) take(person, i + person);
      ++result_.frames;
      result_.interrupted = !progress(static_cast<double>(result_.frames) / static_cast<double>(frame_count_));
    }
  }

  /// Takes the row of before_.frames[i], which is a frame of this person.
  void take(std::size_t person, std::size_t i) {
    const DetectorFrame& frame = before_.frames[i];
    ContactRow& row = before_.rows[i];
    ContactRow* const other = plan_.expectation.detectors != nullptr ? &expected_.rows[i] : nullptr;
    const auto avatar = static_cast<std::uint16_t>(person + 1);
    result_.work += before_.work[i];
    people_[person].take(frame, row, other, trace_.collider_ids());
    if (other != nullptr) result_.comparison->add(row, *other);
    if (recorded_) result_.comparison->add(row, recorded_->row_of(frame.index, avatar));
    if (plan_.contacts != nullptr) plan_.contacts->write(avatar, frame, row, trace_.collider_ids());
    if (plan_.textures != nullptr) plan_.textures->add(person, frame, row);
  }

  void finish() {
    if (size_.is_alone()) result_.detection_s += building_s_;  // several threads had it within their time
    std::vector<std::string> hashes;
    std::vector<std::string> contacts_hashes;
    for (PersonReplay& person : people_) {
      const PersonResult& found = result_.people.emplace_back(person.finish());
      hashes.push_back(found.texture_hash);
      contacts_hashes.push_back(found.contacts_hash);
      result_.contacts += found.contacts;
      result_.origin_changes += found.origin_changes;
      result_.non_finite_frames += found.non_finite_frames;
      result_.non_finite_segments += found.non_finite_segments;
      if (found.first_non_finite)
        result_.first_non_finite =
            std::min(*found.first_non_finite, result_.first_non_finite.value_or(*found.first_non_finite));
    }
    result_.texture_hash = texture_hash_of(hashes);
    result_.contacts_hash = texture_hash_of(contacts_hashes);
    if (!recorded_ || result_.interrupted) return;
    result_.comparison->missing += recorded_->strangers();
    result_.comparison->expected += recorded_->strangers();
  }

  TraceReader& trace_;
  DetectorTeam& detectors_;
  const ReplayPlan& plan_;
  std::uint64_t frame_count_;
  std::uint64_t skinning_step_;  ///< of frames whose skinning is checked
  ColliderMoves colliders_;
  std::vector<PersonReplay> people_;
  std::optional<RecordedRows> recorded_;
  BatchSize size_;
  TraceFrame trace_frame_;
  bool holds_frame_ = false;  ///< trace_frame_ is in no batch yet
  std::uint64_t last_run_ = 0;
  std::size_t next_runs_ = 0;  ///< in `next_`
  std::uint64_t frames_read_ = 0;
  std::exception_ptr read_failure_;
  FrameBatch before_;
  FrameBatch batch_;
  FrameBatch next_;
  FrameBatch expected_;  ///< of `before_`, from the detectors to compare with
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
