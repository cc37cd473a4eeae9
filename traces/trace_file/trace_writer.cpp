#include "traces/trace_file/trace_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <version.hpp>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/append_file.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/scene/people.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_messages.hpp"
#include "traces/viz/viz_format.hpp"
#include "traces/viz/viz_messages.hpp"
#include "traces/viz/viz_pace.hpp"

namespace vestige {

namespace {

using Clock = std::chrono::steady_clock;
using trace_format::Stream;

/// An attachment's name and bytes.
using NamedBytes = std::pair<std::string, mcap::Bytes>;

std::vector<NamedBytes> list_attachments(const TraceAttachments& from, std::size_t person) {
  using trace_format::attachment_name;
  using trace_format::AttachmentKind;
  std::vector<NamedBytes> all = {{attachment_name(AttachmentKind::kAvatar, person), from.avatar_glb}};
  if (!from.actuator_map_png.empty())
    all.emplace_back(attachment_name(AttachmentKind::kMapImage, person), from.actuator_map_png);
  if (!from.actuator_map_json.empty())
    all.emplace_back(attachment_name(AttachmentKind::kMapText, person),
                     std::as_bytes(std::span(from.actuator_map_json)));
  return all;
}

/// Returns the node names as a JSON array. Bytes that are not valid UTF-8 become U+FFFD.
std::string node_names(const Avatar& avatar) {
  nlohmann::json names = nlohmann::json::array();
  for (const Node& node : avatar.nodes) names.push_back(node.name);
  return names.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

mcap::WriterOptions writer_options(const TraceWriterOptions& options) {
  return {.compression = options.compression, .definitions = mcap::DefinitionPlace::kBeforeChunks};
}

}  // namespace

class TraceWriter::Implementation {
 public:
  /// An event that is not written yet.
  struct Note {
    std::string_view kind;  ///< a constant of trace_format
    std::uint64_t count = 0;
    std::string text;
  };

  Implementation(const std::filesystem::path& path, Session session, const std::vector<TracePerson>& people,
                 const TraceWriterOptions& options);

  void write(const TraceFrame& frame);
  void note(Note note);
  void write_old_chunk();
  void close_chunk();
  void finish();
  void abandon() noexcept;

  std::uint64_t frame_count() const { return frame_count_; }
  std::uint64_t bytes_written() const { return writer_.bytes_written(); }
  std::uint64_t bytes_if_finished_with(const TraceFrame& frame) const;

 private:
  void require_usable() const;
  void require_valid(const TraceFrame& frame);
  void require_valid_colliders(const TraceFrame& frame);
  void define(Stream stream);
  void define_pose(std::size_t person, const mcap::StringMap& metadata);
  void write_message(Stream stream, mcap::Bytes data);
  void write_event(const TraceEvent& event);
  void write_notes();
  void write_viz(const TraceFrame& frame);
  void write_message(std::uint16_t channel_id, mcap::Bytes data);
  void write_open_chunk();
  bool chunk_is_old() const;
  [[noreturn]] void refuse(const TraceFrame& frame, std::string_view cause, std::string_view remedy = {}) const;

  std::filesystem::path path_;
  TraceWriterOptions options_;
  AppendFile file_;
  mcap::Writer writer_;
  MessageEncoder encoder_;
  std::optional<VizBodies> bodies_;
  std::optional<VizEncoder> viz_;  ///< of the bodies
  VizPace viz_pace_ = VizPace(viz_format::kRate_hz);
  int version_;
  std::vector<std::size_t> node_counts_;  ///< by person
  std::vector<std::uint32_t> ids_;        ///< collider ids of one frame, sorted
  std::vector<Note> notes_;               ///< notes that wait for the next frame
  Clock::time_point chunk_opened_;
  std::uint64_t frame_count_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the last frame
  std::int64_t time_ns_ = 0;    ///< of the last frame
  bool events_defined_ = false;
  bool usable_ = true;
};

TraceWriter::Implementation::Implementation(const std::filesystem::path& path, Session session,
                                            const std::vector<TracePerson>& people, const TraceWriterOptions& options)
    : path_(path),
      options_(options),
      file_(path, options.overwrite, options.unfinished),
      writer_([this](mcap::Bytes bytes) { file_.write(bytes); },
              {.profile = std::string(trace_format::kProfile), .library = fmt::format("vestige {}", kVersion)},
              writer_options(options)),
      version_(people.size() > 1 || options.owners == Owners::kPeople ? trace_format::kPeopleVersion
                                                                      : trace_format::version_with(options.shape)) {
  using trace_format::numbered;
  if (people.empty() || people.size() > trace_format::kMostPeople)
    throw Error(path.string(), fmt::format("a trace cannot hold {} people", people.size()),
                fmt::format("record 1 to {}", trace_format::kMostPeople));
  session.insert_or_assign(std::string(trace_format::kVersionKey), fmt::format("{}", version_));
  std::vector<mcap::StringMap> of_poses;
  std::vector<NamedBytes> attachments;
  node_counts_.reserve(people.size());
  for (std::size_t person = 0; person < people.size(); ++person) {
    const TracePerson& one = people[person];
    node_counts_.push_back(one.avatar.nodes.size());
    session.emplace(numbered(trace_format::kFacingKey, person), to_string(one.avatar.facing.axis));
    if (!one.name.empty()) session.insert_or_assign(numbered(trace_format::kNameKey, person), one.name);
    mcap::StringMap& metadata = of_poses.emplace_back();
    metadata.emplace(trace_format::kNodesKey, node_names(one.avatar));
    for (NamedBytes& attachment : list_attachments(one.attachments, person)) {
      const std::string sha256 = sha256_hex(attachment.second);
      session.insert_or_assign(trace_format::sha256_key(attachment.first), sha256);
      metadata.emplace(trace_format::sha256_key(attachment.first), sha256);
      attachments.push_back(std::move(attachment));
    }
  }
  writer_.write(mcap::Metadata{.name = std::string(trace_format::kSessionName), .metadata = std::move(session)});
  for (const auto& [name, bytes] : attachments) writer_.write(trace_format::attachment_of(name, bytes));
  writer_.write(trace_format::schema_of(Stream::kPose, version_));
  for (std::size_t person = 0; person < people.size(); ++person) define_pose(person, of_poses[person]);
  define(Stream::kColliders);
  if (options.viz == Viz::kScene) {
    std::vector<const Avatar*> avatars;
    avatars.reserve(people.size());
    for (const TracePerson& person : people) avatars.push_back(&person.avatar);
    viz_.emplace(bodies_.emplace(avatars));
    writer_.write(viz_format::transforms_schema());
    writer_.write(viz_format::scene_schema());
    for (const mcap::Channel& channel : viz_format::channels()) writer_.write(channel);
  }
  file_.sync();
}

void TraceWriter::Implementation::define(Stream stream) {
  writer_.write(trace_format::schema_of(stream, version_));
  writer_.write(trace_format::channel_of(stream, version_));
}

/// All channels /pose share one schema.
void TraceWriter::Implementation::define_pose(std::size_t person, const mcap::StringMap& metadata) {
  mcap::Channel channel = trace_format::channel_of(Stream::kPose, version_, person);
  channel.metadata.insert(metadata.begin(), metadata.end());
  writer_.write(channel);
}

void TraceWriter::Implementation::refuse(const TraceFrame& frame, std::string_view cause,
                                         std::string_view remedy) const {
  throw Error(path_.string(), fmt::format("frame {} cannot be recorded: {}", frame.index, cause), remedy);
}

void TraceWriter::Implementation::require_usable() const {
  if (!usable_) throw Error(path_.string(), "is closed, or an earlier write failed", "record it again");
}

void TraceWriter::Implementation::require_valid(const TraceFrame& frame) {
  if (frame.index > std::numeric_limits<std::uint32_t>::max()) refuse(frame, "MCAP numbers messages with 32 bits");
  if (frame_count_ > 0 && frame.index <= sequence_) refuse(frame, fmt::format("it comes after frame {}", sequence_));
  if (frame.time_ns < time_ns_)
    refuse(frame,
           fmt::format("its time, {} ns, is earlier than that of the last frame, {} ns", frame.time_ns, time_ns_));
  if (frame.poses.size() != node_counts_.size())
    refuse(frame, fmt::format("it has {} poses for {} people", frame.poses.size(), node_counts_.size()));
  for (std::size_t person = 0; person < node_counts_.size(); ++person)
    if (const std::size_t nodes = frame.poses[person].nodes.size(); nodes != node_counts_[person])
      refuse(frame, fmt::format("its pose{} has {} nodes, but the avatar has {}",
                                node_counts_.size() == 1 ? "" : fmt::format(" of person {}", person + 1), nodes,
                                node_counts_[person]));
  require_valid_colliders(frame);
}

void TraceWriter::Implementation::require_valid_colliders(const TraceFrame& frame) {
  ids_.clear();
  for (const ColliderSample& collider : frame.colliders) {
    ids_.push_back(collider.id);
    if (const std::string_view fault = radius_fault(double{collider.radius_m}); !fault.empty())
      refuse(frame, fmt::format("the radius of collider {}, {} m, {}", collider.id, collider.radius_m, fault));
    if (version_ == trace_format::kPointsVersion && collider.radius_m != 0)
      refuse(frame, fmt::format("collider {} has a radius in a trace of points", collider.id));
    if (version_ != trace_format::kPeopleVersion && collider.owner != kNobody)
      refuse(frame, fmt::format("collider {} has an owner in a trace without owners", collider.id));
  }
  if (const auto fault = owner_fault(frame.colliders, node_counts_.size()))
    refuse(frame, *fault, "name a person who is there, or 0 for nobody's");
  std::sort(ids_.begin(), ids_.end());
  const auto twice = std::adjacent_find(ids_.begin(), ids_.end());
  if (twice != ids_.end()) refuse(frame, fmt::format("it has collider {} twice", *twice));
}

void TraceWriter::Implementation::write_message(std::uint16_t channel_id, mcap::Bytes data) {
  const auto time = static_cast<std::uint64_t>(time_ns_);
  writer_.write(mcap::Message{
      .channel_id = channel_id, .sequence = sequence_, .log_time = time, .publish_time = time, .data = data});
}

void TraceWriter::Implementation::write_message(Stream stream, mcap::Bytes data) {
  write_message(trace_format::kStreams.at(static_cast<std::size_t>(stream)).id, data);
}

/// Writes viewer messages at the first frame of each sixtieth of a second.
void TraceWriter::Implementation::write_viz(const TraceFrame& frame) {
  if (!viz_ || !viz_pace_.is_due(frame.time_ns)) return;
  viz_pace_.end_slot(frame.time_ns);
  bodies_->take(frame);
  write_message(viz_format::kTransformsId, viz_->transforms(frame));
  write_message(viz_format::kSceneId, viz_->scene(frame));
}

void TraceWriter::Implementation::write_event(const TraceEvent& event) {
  if (!events_defined_) define(Stream::kEvents);
  events_defined_ = true;
  write_message(Stream::kEvents, encoder_.event(event));
}

void TraceWriter::Implementation::write(const TraceFrame& frame) {
  require_usable();
  require_valid(frame);
  usable_ = false;
  if (writer_.open_chunk_bytes() == 0) chunk_opened_ = Clock::now();
  sequence_ = static_cast<std::uint32_t>(frame.index);
  time_ns_ = frame.time_ns;
  write_notes();
  for (const std::uint32_t collider : frame.teleported)
    write_event({.time_ns = time_ns_, .kind = trace_format::kTeleportKind, .collider = collider, .text = {}});
  for (std::size_t person = 0; person < frame.poses.size(); ++person)
    write_message(trace_format::pose_channel_id(person), encoder_.pose(time_ns_, frame.poses[person]));
  write_message(Stream::kColliders, encoder_.colliders(time_ns_, frame.colliders));
  write_viz(frame);
  ++frame_count_;
  if (writer_.open_chunk_bytes() >= options_.chunk_bytes || chunk_is_old()) write_open_chunk();
  usable_ = true;
}

void TraceWriter::Implementation::write_notes() {
  for (const Note& note : notes_)
    write_event({.time_ns = time_ns_, .kind = note.kind, .count = note.count, .text = note.text});
  notes_.clear();
}

void TraceWriter::Implementation::note(Note note) {
  require_usable();
  notes_.push_back(std::move(note));
}

bool TraceWriter::Implementation::chunk_is_old() const {
  const std::chrono::duration<double> age = Clock::now() - chunk_opened_;
  return writer_.open_chunk_bytes() > 0 && age.count() >= options_.chunk_s;
}

void TraceWriter::Implementation::write_open_chunk() {
  const std::uint64_t before = writer_.bytes_written();
  writer_.close_chunk();
  if (frame_count_ > 0) file_.keep();
  if (options_.sync == ChunkSync::kEach && writer_.bytes_written() > before) file_.sync();
}

void TraceWriter::Implementation::write_old_chunk() {
  if (chunk_is_old()) close_chunk();
}

void TraceWriter::Implementation::close_chunk() {
  require_usable();
  usable_ = false;
  write_open_chunk();
  usable_ = true;
}

std::uint64_t TraceWriter::Implementation::bytes_if_finished_with(const TraceFrame& frame) const {
  // Size of a FlatBuffer, its message record and its index entry, without the parts counted below.
  constexpr std::uint64_t kMessageBytes = 192;
  constexpr std::uint64_t kNodeBytes = 40;
  const std::uint64_t collider_bytes = version_ == trace_format::kPeopleVersion ? 38 : 36;
  constexpr std::uint64_t kEventsChannelBytes = 4096;  // holds its schema twice
  std::uint64_t bytes = writer_.bytes_if_finished() + 1024;
  bytes += kMessageBytes + collider_bytes * frame.colliders.size();
  for (const Pose& pose : frame.poses) bytes += kMessageBytes + kNodeBytes * pose.nodes.size();
  bytes += kMessageBytes * frame.teleported.size();
  for (const Note& note : notes_) bytes += kMessageBytes + note.text.size();
  if (viz_ && viz_pace_.is_due(frame.time_ns)) bytes += viz_->most_bytes(frame);
  if (!events_defined_ && !(frame.teleported.empty() && notes_.empty())) bytes += kEventsChannelBytes;
  return bytes;
}

void TraceWriter::Implementation::finish() {
  require_usable();
  usable_ = false;
  write_notes();
  write_open_chunk();
  writer_.finish();
  file_.close();
}

void TraceWriter::Implementation::abandon() noexcept {
  try {
    if (!usable_) return;
    write_notes();
    write_open_chunk();
  } catch (const std::exception&) {
    // AppendFile has kept what it could; a destructor cannot report the error.
    usable_ = false;
  }
}

TraceWriter::TraceWriter(const std::filesystem::path& path, Session session, const std::vector<TracePerson>& people,
                         const TraceWriterOptions& options)
    : implementation_(std::make_unique<Implementation>(path, std::move(session), people, options)) {}

TraceWriter::~TraceWriter() {
  implementation_->abandon();
}

void TraceWriter::write(const TraceFrame& frame) {
  implementation_->write(frame);
}

void TraceWriter::note_dropped(std::string_view topic, std::uint64_t count) {
  implementation_->note({.kind = trace_format::kDroppedKind, .count = count, .text = std::string(topic)});
}

void TraceWriter::note_superseded(std::uint64_t count) {
  implementation_->note({.kind = trace_format::kSupersededKind, .count = count, .text = {}});
}

void TraceWriter::note_marker(std::string_view text) {
  implementation_->note({.kind = trace_format::kMarkerKind, .text = std::string(text)});
}

void TraceWriter::write_old_chunk() {
  implementation_->write_old_chunk();
}

void TraceWriter::close_chunk() {
  implementation_->close_chunk();
}

void TraceWriter::finish() {
  implementation_->finish();
}

std::uint64_t TraceWriter::frame_count() const {
  return implementation_->frame_count();
}

std::uint64_t TraceWriter::bytes_written() const {
  return implementation_->bytes_written();
}

std::uint64_t TraceWriter::bytes_if_finished_with(const TraceFrame& frame) const {
  return implementation_->bytes_if_finished_with(frame);
}

}  // namespace vestige
