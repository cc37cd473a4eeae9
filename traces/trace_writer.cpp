#include "traces/trace_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <version.hpp>

#include "traces/append_file.hpp"
#include "traces/error.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/sha256.hpp"
#include "traces/trace_format.hpp"
#include "traces/trace_messages.hpp"

namespace vestige {

namespace {

using Clock = std::chrono::steady_clock;
using trace_format::Stream;

mcap::Attachment attachment(std::string_view name, std::string_view media_type, std::span<const std::byte> data) {
  return {.name = std::string(name), .media_type = std::string(media_type), .data = data};
}

std::vector<mcap::Attachment> list_attachments(const TraceAttachments& from) {
  std::vector<mcap::Attachment> all = {attachment(trace_format::kAvatarName, "model/gltf-binary", from.avatar_glb)};
  if (!from.actuator_map_png.empty())
    all.push_back(attachment(trace_format::kMapImageName, "image/png", from.actuator_map_png));
  if (!from.actuator_map_json.empty())
    all.push_back(
        attachment(trace_format::kMapTextName, "application/json", std::as_bytes(std::span(from.actuator_map_json))));
  return all;
}

/// A JSON array; bytes of a name that are no UTF-8 become U+FFFD.
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
  Implementation(const std::filesystem::path& path, Session session, const Avatar& avatar,
                 const TraceAttachments& attachments, const TraceWriterOptions& options);

  void write(const TraceFrame& frame);
  void note(TraceEvent event);
  void finish();
  void abandon() noexcept;

  std::uint64_t frame_count() const { return frame_count_; }
  std::uint64_t bytes_written() const { return writer_.bytes_written(); }

 private:
  void require_usable() const;
  void require_valid(const TraceFrame& frame);
  void define(Stream stream, const mcap::StringMap& metadata);
  void write_message(Stream stream, mcap::Bytes data);
  void write_event(const TraceEvent& event);
  void close_chunk();
  void close_full_or_old_chunk();
  [[noreturn]] void refuse(const TraceFrame& frame, std::string_view cause) const;

  std::filesystem::path path_;
  TraceWriterOptions options_;
  AppendFile file_;
  mcap::Writer writer_;
  MessageEncoder encoder_;
  std::size_t node_count_;
  std::vector<std::uint32_t> ids_;  ///< of one frame, sorted
  Clock::time_point chunk_opened_;
  std::uint64_t frame_count_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the last frame
  std::int64_t time_ns_ = 0;    ///< of the last frame
  bool events_defined_ = false;
  bool usable_ = true;
};

TraceWriter::Implementation::Implementation(const std::filesystem::path& path, Session session, const Avatar& avatar,
                                            const TraceAttachments& attachments, const TraceWriterOptions& options)
    : path_(path),
      options_(options),
      file_(path, options.overwrite),
      writer_([this](mcap::Bytes bytes) { file_.write(bytes); },
              {.profile = std::string(trace_format::kProfile), .library = fmt::format("vestige {}", kVersion)},
              writer_options(options)),
      node_count_(avatar.nodes.size()) {
  const std::vector<mcap::Attachment> all = list_attachments(attachments);
  session.insert_or_assign(std::string(trace_format::kVersionKey), std::string(trace_format::kVersion));
  for (const mcap::Attachment& one : all)
    session.insert_or_assign(fmt::format("{}{}", trace_format::kSha256Prefix, one.name), sha256_hex(one.data));
  writer_.write(mcap::Metadata{.name = std::string(trace_format::kSessionName), .metadata = std::move(session)});
  for (const mcap::Attachment& one : all) writer_.write(one);
  define(Stream::kPose, {{std::string(trace_format::kNodesKey), node_names(avatar)}});
  define(Stream::kColliders, {});
  file_.secure();
}

void TraceWriter::Implementation::define(Stream stream, const mcap::StringMap& metadata) {
  mcap::Channel channel = trace_format::channel_of(stream);
  channel.metadata.insert(metadata.begin(), metadata.end());
  writer_.write(trace_format::schema_of(stream));
  writer_.write(channel);
}

void TraceWriter::Implementation::refuse(const TraceFrame& frame, std::string_view cause) const {
  throw Error(path_.string(), fmt::format("frame {} cannot be recorded: {}", frame.index, cause), "");
}

void TraceWriter::Implementation::require_usable() const {
  if (!usable_) throw Error(path_.string(), "is closed, or failed before", "record it again");
}

void TraceWriter::Implementation::require_valid(const TraceFrame& frame) {
  if (frame.index > std::numeric_limits<std::uint32_t>::max()) refuse(frame, "MCAP numbers messages with 32 bits");
  if (frame_count_ > 0 && frame.index <= sequence_) refuse(frame, fmt::format("it comes after frame {}", sequence_));
  if (frame.time_ns < time_ns_)
    refuse(frame, fmt::format("its time, {} ns, is before the last frame's, {} ns", frame.time_ns, time_ns_));
  if (frame.pose.nodes.size() != node_count_)
    refuse(frame, fmt::format("its pose has {} nodes, the avatar {}", frame.pose.nodes.size(), node_count_));
  ids_.clear();
  for (const ColliderSample& collider : frame.colliders) ids_.push_back(collider.id);
  std::sort(ids_.begin(), ids_.end());
  const auto twice = std::adjacent_find(ids_.begin(), ids_.end());
  if (twice != ids_.end()) refuse(frame, fmt::format("collider {} is in it twice", *twice));
}

void TraceWriter::Implementation::write_message(Stream stream, mcap::Bytes data) {
  const auto time = static_cast<std::uint64_t>(time_ns_);
  writer_.write(mcap::Message{.channel_id = trace_format::kStreams.at(static_cast<std::size_t>(stream)).id,
                              .sequence = sequence_,
                              .log_time = time,
                              .publish_time = time,
                              .data = data});
}

void TraceWriter::Implementation::write_event(const TraceEvent& event) {
  if (!events_defined_) define(Stream::kEvents, {});
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
  for (const std::uint32_t collider : frame.teleported)
    write_event({.time_ns = time_ns_, .kind = trace_format::kTeleportKind, .collider = collider, .text = {}});
  write_message(Stream::kPose, encoder_.pose(time_ns_, frame.pose));
  write_message(Stream::kColliders, encoder_.colliders(time_ns_, frame.colliders));
  ++frame_count_;
  close_full_or_old_chunk();
  usable_ = true;
}

void TraceWriter::Implementation::note(TraceEvent event) {
  require_usable();
  usable_ = false;
  if (writer_.open_chunk_bytes() == 0) chunk_opened_ = Clock::now();
  event.time_ns = time_ns_;
  write_event(event);
  usable_ = true;
}

void TraceWriter::Implementation::close_full_or_old_chunk() {
  const std::chrono::duration<double> age = Clock::now() - chunk_opened_;
  if (writer_.open_chunk_bytes() >= options_.chunk_bytes || age.count() >= options_.chunk_s) close_chunk();
}

void TraceWriter::Implementation::close_chunk() {
  writer_.close_chunk();
  if (frame_count_ > 0) file_.keep();
}

void TraceWriter::Implementation::finish() {
  require_usable();
  usable_ = false;
  close_chunk();
  writer_.finish();
  file_.close();
}

void TraceWriter::Implementation::abandon() noexcept {
  try {
    if (usable_) close_chunk();
  } catch (const std::exception&) {
    // AppendFile has kept what it could; there is nobody left to tell.
    usable_ = false;
  }
}

TraceWriter::TraceWriter(const std::filesystem::path& path, Session session, const Avatar& avatar,
                         const TraceAttachments& attachments, const TraceWriterOptions& options)
    : implementation_(std::make_unique<Implementation>(path, std::move(session), avatar, attachments, options)) {}

TraceWriter::~TraceWriter() {
  implementation_->abandon();
}

void TraceWriter::write(const TraceFrame& frame) {
  implementation_->write(frame);
}

void TraceWriter::note_dropped(std::string_view topic, std::uint64_t count) {
  implementation_->note({.kind = trace_format::kDroppedKind, .count = count, .text = topic});
}

void TraceWriter::note_marker(std::string_view text) {
  implementation_->note({.kind = trace_format::kMarkerKind, .text = text});
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

}  // namespace vestige
