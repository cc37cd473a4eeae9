#include "traces/trace_file/trace_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/recovered.hpp"
#include "traces/trace_file/trace_index.hpp"
#include "traces/trace_file/trace_messages.hpp"
#include "traces/trace_file/trace_nodes.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using trace_format::Stream;

constexpr std::size_t kMostWarnings = 1000;
constexpr std::string_view kRecover = "run `vestige recover`, which may still find a part of it";

}  // namespace

class TraceReader::Implementation {
 public:
  Implementation(const std::filesystem::path& path, People allowed, std::size_t threads)
      : source_(path), index_(index_trace(source_)), threads_(threads), frames_(*this, PoseDecoding::kFull) {
    if (index_.recovered) recovered_ = describe_recovered(*index_.recovered);
    for (const mcap::Damage& damage : index_.damages.kept()) warn(damage);
    require_trace();
    require_people(allowed);
    for (std::size_t person = 0; person < index_.people; ++person) people_.push_back(take_person(person));
  }

  const TraceIndex& index() const { return index_; }
  const std::vector<RecordedPerson>& people() const { return people_; }
  /// A damaged session says nothing of the version, so its colliders may have radii.
  ColliderShape shape() const {
    return version_ == trace_format::kPointsVersion ? ColliderShape::kPoints : ColliderShape::kSpheres;
  }
  Owners owners() const {
    return version_.value_or(newest_) < trace_format::kPeopleVersion ? Owners::kNone : Owners::kPeople;
  }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::string& recovered() const { return recovered_; }
  bool complete() const { return index_.has_footer && warnings_.empty(); }
  bool next(TraceFrame& frame) { return frames_.next(frame); }
  void rewind() { frames_.rewind(); }

  struct Census {
    std::vector<std::uint32_t> collider_ids;  ///< ascending
    std::vector<std::uint32_t> sphere_ids;    ///< ascending
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;
  };
  const Census& census();

 private:
  enum class PoseDecoding { kFull, kNodeCount };

  /// Assembles frames from messages.
  class Frames {
   public:
    Frames(Implementation& owner, PoseDecoding decoding)
        : owner_(owner),
          decoding_(decoding),
          messages_(owner.source_, owner.index_.places, owner.index_.streams, owner.threads_,
                    [&owner](const mcap::Damage& damage) { owner.warn(damage); }) {}

    bool next(TraceFrame& frame);
    void rewind();
    /// Reads the next message, and with it the definitions before it.
    bool skip_message() { return messages_.next(message_); }
    std::uint64_t dropped() const { return dropped_; }

   private:
    bool peek() { return held_ || (held_ = messages_.next(message_)); }
    void take(TraceFrame& frame);
    void take_pose(TraceFrame& frame);
    void take_colliders(TraceFrame& frame);
    void end_poses(TraceFrame& frame, std::uint64_t offset, bool is_whole);
    void take_event(TraceFrame& frame);
    [[noreturn]] void refuse(std::string_view cause) const;

    Implementation& owner_;
    PoseDecoding decoding_;
    MessageStream messages_;
    MessageDecoder decoder_;
    TraceMessage message_;
    bool held_ = false;             ///< message_ was read but not yet used
    std::vector<bool> pose_taken_;  ///< by person
    std::size_t poses_taken_ = 0;
    bool colliders_taken_ = false;
    std::optional<std::uint32_t> last_sequence_;
    std::int64_t last_time_ns_ = 0;
    std::uint64_t dropped_ = 0;
  };

  void warn(const mcap::Damage& damage);
  void require_trace();
  void require_people(People allowed);
  RecordedPerson take_person(std::size_t person);
  void require_owners(const TraceFrame& frame);

  mcap::FileSource source_;
  TraceIndex index_;
  std::size_t threads_;
  std::optional<int> version_;
  int newest_ = trace_format::kNewestVersion;  ///< that the caller can handle
  std::vector<RecordedPerson> people_;
  std::map<std::uint32_t, std::uint16_t> owners_;  ///< of the colliders, in a trace that has owners
  std::vector<std::string> warnings_;
  std::string recovered_;
  std::optional<Census> census_;
  Frames frames_;
};

void TraceReader::Implementation::warn(const mcap::Damage& damage) {
  if (warnings_.size() > kMostWarnings) return;
  std::string text = describe(damage, source_.name());
  if (std::find(warnings_.begin(), warnings_.end(), text) != warnings_.end()) return;
  if (warnings_.size() == kMostWarnings)
    text = fmt::format("{}: there are more problems; see `vestige doctor`", source_.name());
  warnings_.push_back(std::move(text));
}

void TraceReader::Implementation::require_trace() {
  const std::string file = source_.name();
  const auto lacks_poses = [&] { return index_.streams.pose_channels().empty(); };
  // Channels may be defined in chunks only.
  while (index_.streams.pose_channels().size() < index_.people && frames_.skip_message()) continue;
  frames_.rewind();
  index_.people = std::max(index_.people, people_of(index_.claims(), index_.streams, {}));
  version_ = version_of(index_.claims());
  if (lacks_poses() && index_.profile_is_ours && !warnings_.empty())
    throw Error(warnings_.front(), "so the file holds no frame", kRecover);
  if (lacks_poses()) {
    throw Error(file,
                index_.profile_is_ours
                    ? "is a trace without the channel /pose"
                    : "is an MCAP file, but not a trace of vestige: it has no channel /pose with vestige's schema",
                "record a trace with `vestige record`; `vestige inspect` shows what is in this file");
  }
}

void TraceReader::Implementation::require_people(People allowed) {
  if (allowed == People::kSeveral) return;
  newest_ = trace_format::kSpheresVersion;
  constexpr std::string_view kRemedy =
      "`vestige replay`, `view`, `viz`, `stream`, `batch`, `sweep`, `plot scene`, `export`, `inspect`, `doctor`, "
      "`cat`, "
      "`trim`, `merge`, `recompress` and `recover` read it";
  if (index_.people > 1)
    throw Error(source_.name(), fmt::format("holds {} people, and this verb reads traces of one person", index_.people),
                kRemedy);
  if (version_ == trace_format::kPeopleVersion)
    throw Error(source_.name(), "may hold colliders that belong to its person, which this verb does not know", kRemedy);
}

RecordedPerson TraceReader::Implementation::take_person(std::size_t person) {
  using trace_format::AttachmentKind;
  const std::string file = source_.name();
  const std::string topic = trace_format::numbered("/pose", person);
  const std::string avatar = trace_format::attachment_name(AttachmentKind::kAvatar, person);
  RecordedPerson taken = {.name = recorded_of(index_.session, trace_format::kNameKey, person),
                          .facing = recorded_of(index_.session, trace_format::kFacingKey, person),
                          .avatar_glb = index_.attachment(AttachmentKind::kAvatar, person),
                          .actuator_map_png = index_.attachment(AttachmentKind::kMapImage, person),
                          .actuator_map_json = index_.attachment(AttachmentKind::kMapText, person),
                          .node_names = {}};
  const mcap::Channel* pose = index_.streams.find(Stream::kPose, person);
  if (pose != nullptr) {
    auto names = parse_node_names(*pose);
    if (!names)
      throw Error(file, fmt::format("its channel {} does not say which nodes the poses have", topic),
                  "record it again");
    taken.node_names = std::move(*names);
  } else {
    warn({0, 0, fmt::format("there is no channel {}, so person {} has no pose in any frame", topic, person + 1)});
  }
  if (taken.avatar_glb.empty())
    throw Error(file, fmt::format("has no undamaged attachment {}", avatar),
                fmt::format("put an intact one in its place: {}", replacing_command(file, index_.claims(), avatar)));
  const auto nodes = glb_node_count(taken.avatar_glb);
  if (pose != nullptr && nodes && *nodes != taken.node_names.size())
    throw Error(file,
                person == 0
                    ? fmt::format("its poses have {} nodes, but its avatar has {}", taken.node_names.size(), *nodes)
                    : fmt::format("its poses {} have {} nodes, but its {} has {}", topic, taken.node_names.size(),
                                  avatar, *nodes),
                "record it again");
  return taken;
}

/// Throws `Error` if a collider belongs to another person than in an earlier frame.
void TraceReader::Implementation::require_owners(const TraceFrame& frame) {
  if (version_.value_or(newest_) < trace_format::kPeopleVersion) return;
  for (const ColliderSample& collider : frame.colliders) {
    const auto [known, is_new] = owners_.try_emplace(collider.id, collider.owner);
    if (known->second != collider.owner)
      throw Error(source_.name(),
                  fmt::format("frame {}: collider {} belongs to {}, but before it belonged to {}", frame.index,
                              collider.id, in_words(collider.owner), in_words(known->second)),
                  "record it again with another id for each owner");
  }
}

const TraceReader::Implementation::Census& TraceReader::Implementation::census() {
  if (census_) return *census_;
  Census census;
  std::set<std::uint32_t> ids;
  std::set<std::uint32_t> sphere_ids;
  Frames frames(*this, PoseDecoding::kNodeCount);
  TraceFrame frame;
  std::vector<std::uint32_t> previous;
  std::vector<std::uint32_t> current;
  std::vector<std::uint32_t> previous_spheres;
  std::vector<std::uint32_t> spheres;
  while (frames.next(frame)) {
    ++census.frames;
    require_owners(frame);
    current.clear();
    spheres.clear();
    for (const ColliderSample& collider : frame.colliders) {
      current.push_back(collider.id);
      if (is_sphere_radius(collider.radius_m)) spheres.push_back(collider.id);
    }
    if (spheres != previous_spheres) {
      previous_spheres = spheres;
      sphere_ids.insert(spheres.begin(), spheres.end());
    }
    if (current == previous) continue;
    previous = current;
    ids.insert(current.begin(), current.end());
    if (ids.size() > kMostColliders)
      throw Error(source_.name(), fmt::format("has more than {} colliders", kMostColliders),
                  "number the colliders anew: an id may be used again when its collider is gone");
  }
  census.collider_ids.assign(ids.begin(), ids.end());
  census.sphere_ids.assign(sphere_ids.begin(), sphere_ids.end());
  census.dropped = frames.dropped();
  return census_.emplace(std::move(census));
}

void TraceReader::Implementation::Frames::rewind() {
  messages_.rewind();
  held_ = false;
  last_sequence_.reset();
  last_time_ns_ = 0;
  dropped_ = 0;
}

void TraceReader::Implementation::Frames::refuse(std::string_view cause) const {
  throw Error(owner_.source_.name(),
              fmt::format("at byte {}: frame {}: {}", message_.offset, message_.message.sequence, cause),
              "run `vestige recover`, which leaves out what does not fit");
}

bool TraceReader::Implementation::Frames::next(TraceFrame& frame) {
  while (peek()) {
    const std::uint32_t sequence = message_.message.sequence;
    const std::uint64_t offset = message_.offset;
    frame.index = sequence;
    frame.poses.resize(owner_.people_.size());
    frame.colliders.clear();
    frame.teleported.clear();
    pose_taken_.assign(owner_.people_.size(), false);
    poses_taken_ = 0;
    colliders_taken_ = false;
    bool is_whole = true;
    do {
      try {
        take(frame);
      } catch (const Malformed& malformed) {
        is_whole = false;
        owner_.warn({message_.offset, 0, fmt::format("a message of frame {}: {}", sequence, malformed.what())});
      }
      held_ = false;
    } while (peek() && message_.message.sequence == sequence);
    if (poses_taken_ > 0) {
      end_poses(frame, offset, is_whole);
      if (!colliders_taken_ && is_whole && owner_.index_.streams.find(Stream::kColliders) != nullptr)
        owner_.warn(
            {offset, 0, fmt::format("frame {} has no message of /colliders, so it has no colliders", sequence)});
      last_sequence_ = sequence;
      last_time_ns_ = frame.time_ns;
      return true;
    }
    if (colliders_taken_) owner_.warn({offset, 0, fmt::format("frame {} has no pose and is left out", sequence)});
  }
  return false;
}

void TraceReader::Implementation::Frames::take(TraceFrame& frame) {
  if (message_.stream == Stream::kEvents) {
    take_event(frame);
    return;
  }
  if (last_sequence_ && message_.message.sequence <= *last_sequence_)
    refuse(fmt::format("comes after frame {}", *last_sequence_));
  if (message_.stream == Stream::kPose)
    take_pose(frame);
  else
    take_colliders(frame);
}

void TraceReader::Implementation::Frames::take_colliders(TraceFrame& frame) {
  if (colliders_taken_) refuse("has its colliders twice");
  decoder_.colliders(message_.message.data, frame.colliders);
  const auto any = [&](auto fails) { return std::ranges::any_of(frame.colliders, fails); };
  const auto leave_out = [&](const std::string& cause) {
    frame.colliders.clear();
    throw Malformed(cause);
  };
  const int version = owner_.version_.value_or(owner_.newest_);
  if (version < trace_format::kSpheresVersion && any([](const auto& collider) { return collider.radius_m != 0; }))
    leave_out("its colliders have radii, which its schema does not have");
  if (version < trace_format::kPeopleVersion && any([](const auto& collider) { return collider.owner != kNobody; }))
    leave_out("its colliders have owners, which its schema does not have");
  if (const auto fault = owner_fault(frame.colliders, owner_.people_.size())) leave_out(*fault);
  colliders_taken_ = true;
}

void TraceReader::Implementation::Frames::take_pose(TraceFrame& frame) {
  const std::size_t person = message_.person;
  if (person >= owner_.people_.size()) return;  // another program's: the format version knows one person
  if (pose_taken_[person])
    refuse(owner_.people_.size() == 1 ? "has two poses" : fmt::format("has two poses of person {}", person + 1));
  const std::size_t nodes = decoding_ == PoseDecoding::kFull ? decoder_.pose(message_.message.data, frame.poses[person])
                                                             : decoder_.pose_node_count(message_.message.data);
  const std::size_t expected = owner_.people_[person].node_names.size();
  if (nodes != expected) refuse(fmt::format("its pose has {} nodes, but the avatar has {}", nodes, expected));
  if (message_.message.log_time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    refuse("its time is out of range");
  const auto time_ns = static_cast<std::int64_t>(message_.message.log_time);
  if (poses_taken_ > 0 && time_ns != frame.time_ns)
    refuse(fmt::format("its poses are of different times, {} ns and {} ns", frame.time_ns, time_ns));
  frame.time_ns = time_ns;
  if (last_sequence_ && frame.time_ns < last_time_ns_)
    refuse(
        fmt::format("its time, {} ns, is earlier than that of the frame before, {} ns", frame.time_ns, last_time_ns_));
  pose_taken_[person] = true;
  ++poses_taken_;
}

/// Empties the poses that the frame does not have.
void TraceReader::Implementation::Frames::end_poses(TraceFrame& frame, std::uint64_t offset, bool is_whole) {
  if (poses_taken_ == frame.poses.size()) return;
  for (std::size_t person = 0; person < frame.poses.size(); ++person) {
    if (pose_taken_[person]) continue;
    frame.poses[person] = {};
    if (is_whole && owner_.index_.streams.find(Stream::kPose, person) != nullptr)
      owner_.warn({offset, 0, fmt::format("frame {} has no pose of person {}", frame.index, person + 1)});
  }
}

void TraceReader::Implementation::Frames::take_event(TraceFrame& frame) {
  const TraceEvent event = decoder_.event(message_.message.data);
  if (event.kind == trace_format::kTeleportKind) {
    if (frame.teleported.size() == kMostColliders) refuse(fmt::format("has more than {} teleports", kMostColliders));
    frame.teleported.push_back(event.collider);
  }
  if (event.kind == trace_format::kDroppedKind) dropped_ += event.count;
}

TraceReader::TraceReader(const std::filesystem::path& path, People allowed, std::size_t threads)
    : implementation_(std::make_unique<Implementation>(path, allowed, threads)) {}
TraceReader::~TraceReader() = default;

const Session& TraceReader::session() const {
  return implementation_->index().session;
}
const std::vector<RecordedPerson>& TraceReader::people() const {
  return implementation_->people();
}
ColliderShape TraceReader::shape() const {
  return implementation_->shape();
}
Owners TraceReader::owners() const {
  return implementation_->owners();
}
const std::vector<std::uint32_t>& TraceReader::collider_ids() {
  return implementation_->census().collider_ids;
}
const std::vector<std::uint32_t>& TraceReader::sphere_ids() {
  return implementation_->census().sphere_ids;
}
std::uint64_t TraceReader::frame_count() {
  return implementation_->census().frames;
}
std::uint64_t TraceReader::dropped() {
  return implementation_->census().dropped;
}
bool TraceReader::next(TraceFrame& frame) {
  return implementation_->next(frame);
}
void TraceReader::rewind() {
  implementation_->rewind();
}
bool TraceReader::complete() const {
  return implementation_->complete();
}
const std::vector<std::string>& TraceReader::warnings() const {
  return implementation_->warnings();
}

const std::string& TraceReader::recovered() const {
  return implementation_->recovered();
}

void require_frames(TraceReader& trace, const std::string& name) {
  if (trace.frame_count() > 0) return;
  if (!trace.warnings().empty()) throw Error(trace.warnings().front(), "so the file holds no frame", kRecover);
  throw Error(name, "holds no frame", "record it again");
}

std::vector<std::string> damage_of(const TraceReader& trace, std::string_view name) {
  if (trace.complete()) return {};
  if (!trace.warnings().empty()) return trace.warnings();
  return {fmt::format("{}: is not complete", name)};
}

}  // namespace vestige
