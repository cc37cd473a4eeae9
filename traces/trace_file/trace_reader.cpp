#include "traces/trace_file/trace_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/byte_source.hpp"
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
constexpr std::size_t kMostColliders = 1'000'000;  ///< in a trace; also the most teleports in a frame
constexpr std::string_view kRecover = "run `vestige recover`, which may still find a part of it";

/// The schemas count; where they are foreign, what the session says. A damaged session says nothing, so its colliders
/// may have radii.
ColliderShape recorded_shape(const TraceIndex& index) {
  std::optional<int> version = index.streams.version_of_schemas();
  if (const auto text = index.session.find(std::string(trace_format::kVersionKey));
      !version && text != index.session.end())
    version = trace_format::parse_version(text->second);
  return version == trace_format::kPointsVersion ? ColliderShape::kPoints : ColliderShape::kSpheres;
}

}  // namespace

class TraceReader::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path)
      : source_(path), index_(index_trace(source_)), frames_(*this, PoseDecoding::kFull) {
    if (index_.recovered) recovered_ = describe_recovered(*index_.recovered);
    for (const mcap::Damage& damage : index_.damages.kept()) warn(damage);
    require_trace();
    shape_ = recorded_shape(index_);
  }

  const TraceIndex& index() const { return index_; }
  const std::vector<std::string>& node_names() const { return node_names_; }
  ColliderShape shape() const { return shape_; }
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
          messages_(owner.source_, owner.index_.places, owner.index_.streams,
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
    void take_event(TraceFrame& frame);
    [[noreturn]] void refuse(std::string_view cause) const;

    Implementation& owner_;
    PoseDecoding decoding_;
    MessageStream messages_;
    MessageDecoder decoder_;
    TraceMessage message_;
    bool held_ = false;  ///< message_ was read but not yet used
    bool pose_taken_ = false;
    bool colliders_taken_ = false;
    std::optional<std::uint32_t> last_sequence_;
    std::int64_t last_time_ns_ = 0;
    std::uint64_t dropped_ = 0;
  };

  void warn(const mcap::Damage& damage);
  void require_trace();

  mcap::FileSource source_;
  TraceIndex index_;
  ColliderShape shape_ = ColliderShape::kPoints;
  std::vector<std::string> node_names_;
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
  while (index_.streams.find(Stream::kPose) == nullptr && frames_.skip_message()) continue;
  frames_.rewind();
  const mcap::Channel* pose = index_.streams.find(Stream::kPose);
  if (pose == nullptr && index_.profile_is_ours && !warnings_.empty())
    throw Error(warnings_.front(), "so the file holds no frame", kRecover);
  if (pose == nullptr) {
    throw Error(file,
                index_.profile_is_ours
                    ? "is a trace without the channel /pose"
                    : "is an MCAP file, but not a trace of vestige: it has no channel /pose with vestige's schema",
                "record a trace with `vestige record`; `vestige inspect` shows what is in this file");
  }
  auto names = parse_node_names(*pose);
  if (!names) throw Error(file, "its channel /pose does not say which nodes the poses have", "record it again");
  node_names_ = std::move(*names);
  if (index_.avatar_glb.empty()) {
    throw Error(file, "has no undamaged attachment avatar.glb",
                fmt::format("put an intact one in its place: {}",
                            replacing_command(file, index_.claims(), trace_format::kAvatarName)));
  }
  const auto nodes = glb_node_count(index_.avatar_glb);
  if (nodes && *nodes != node_names_.size()) {
    throw Error(file, fmt::format("its poses have {} nodes, but its avatar has {}", node_names_.size(), *nodes),
                "record it again");
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
    frame.colliders.clear();
    frame.teleported.clear();
    pose_taken_ = colliders_taken_ = false;
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
    if (pose_taken_) {
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
  if (message_.stream == Stream::kPose) {
    take_pose(frame);
    return;
  }
  if (colliders_taken_) refuse("has its colliders twice");
  decoder_.colliders(message_.message.data, frame.colliders);
  if (owner_.shape_ == ColliderShape::kPoints &&
      std::ranges::any_of(frame.colliders, [](const ColliderSample& collider) { return collider.radius_m != 0; })) {
    frame.colliders.clear();
    throw Malformed("its colliders have radii, which its schema does not have");
  }
  colliders_taken_ = true;
}

void TraceReader::Implementation::Frames::take_pose(TraceFrame& frame) {
  if (pose_taken_) refuse("has two poses");
  const std::size_t nodes = decoding_ == PoseDecoding::kFull ? decoder_.pose(message_.message.data, frame.pose)
                                                             : decoder_.pose_node_count(message_.message.data);
  if (nodes != owner_.node_names_.size())
    refuse(fmt::format("its pose has {} nodes, but the avatar has {}", nodes, owner_.node_names_.size()));
  if (message_.message.log_time > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    refuse("its time is out of range");
  frame.time_ns = static_cast<std::int64_t>(message_.message.log_time);
  if (last_sequence_ && frame.time_ns < last_time_ns_)
    refuse(
        fmt::format("its time, {} ns, is earlier than that of the frame before, {} ns", frame.time_ns, last_time_ns_));
  pose_taken_ = true;
}

void TraceReader::Implementation::Frames::take_event(TraceFrame& frame) {
  const TraceEvent event = decoder_.event(message_.message.data);
  if (event.kind == trace_format::kTeleportKind) {
    if (frame.teleported.size() == kMostColliders) refuse(fmt::format("has more than {} teleports", kMostColliders));
    frame.teleported.push_back(event.collider);
  }
  if (event.kind == trace_format::kDroppedKind) dropped_ += event.count;
}

TraceReader::TraceReader(const std::filesystem::path& path) : implementation_(std::make_unique<Implementation>(path)) {}
TraceReader::~TraceReader() = default;

std::string TraceReader::facing() const {
  const auto found = session().find(std::string(trace_format::kFacingKey));
  return found == session().end() ? "" : found->second;
}

const Session& TraceReader::session() const {
  return implementation_->index().session;
}
std::span<const std::byte> TraceReader::avatar_glb() const {
  return implementation_->index().avatar_glb;
}
std::span<const std::byte> TraceReader::actuator_map_png() const {
  return implementation_->index().actuator_map_png;
}
std::span<const std::byte> TraceReader::actuator_map_json() const {
  return implementation_->index().actuator_map_json;
}
ColliderShape TraceReader::shape() const {
  return implementation_->shape();
}
const std::vector<std::string>& TraceReader::node_names() const {
  return implementation_->node_names();
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
