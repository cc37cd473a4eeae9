#include "traces/repair/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/check/summary_check.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/scene/people.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/mcap_output.hpp"
#include "traces/trace_file/trace_index.hpp"

namespace vestige {

namespace {

using mcap::ByteSource;
using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

constexpr const char* kOneRecording = "merge only parts of one recording, such as `vestige trim` makes";

/// The sort key of messages.
struct Moment {
  std::uint64_t time_ns = 0;
  std::uint32_t sequence = 0;
  bool operator==(const Moment&) const = default;
  bool operator<(const Moment& other) const {
    return time_ns != other.time_ns ? time_ns < other.time_ns : sequence < other.sequence;
  }
};

Moment moment_of(const mcap::Message& message) {
  return {.time_ns = message.log_time, .sequence = message.sequence};
}

/// What must be the same in all parts: the SHA-256 of each person's avatar, map and map's description.
struct Identity {
  std::size_t people = 1;
  std::map<std::string, std::string> sha256;
};

Identity identity_of(const TraceIndex& index) {
  Identity identity = {.people = index.people, .sha256 = {}};
  for (const auto& [name, data] : index.attachments) identity.sha256[name] = sha256_hex(data);
  return identity;
}

bool is_trace(const Definitions& definitions) {
  return std::any_of(definitions.channels.begin(), definitions.channels.end(), [&](const auto& entry) {
    const auto schema = definitions.schemas.find(entry.second.schema_id);
    return trace_format::recognise(entry.second, schema == definitions.schemas.end() ? nullptr : &schema->second)
               .stream == Stream::kPose;
  });
}

template <typename Map>
void require_same(const Map& known, const Map& added, std::string_view kind, const ByteSource& first,
                  const ByteSource& other) {
  for (const auto& [id, record] : added) {
    const auto found = known.find(id);
    if (found == known.end() || found->second == record) continue;
    throw Error(other.name(), fmt::format("its {} {} differs from that of {}", kind, id, first.name()), kOneRecording);
  }
}

void require_same(const Identity& known, const Identity& added, const ByteSource& first, const ByteSource& other) {
  using trace_format::AttachmentKind;
  if (added.people != known.people)
    throw Error(other.name(),
                fmt::format("holds {}, and {} holds {}", count_of_people(added.people), first.name(),
                            count_of_people(known.people)),
                kOneRecording);
  const auto sha256 = [](const Identity& identity, const std::string& name) {
    const auto found = identity.sha256.find(name);
    return found == identity.sha256.end() ? std::string() : found->second;
  };
  for (std::size_t person = 0; person < known.people; ++person)
    for (const AttachmentKind part : trace_format::kAttachmentKinds) {
      const std::string name = trace_format::attachment_name(part, person);
      if (sha256(added, name) == sha256(known, name)) continue;
      const std::string_view what = part == AttachmentKind::kAvatar     ? "avatar"
                                    : part == AttachmentKind::kMapImage ? "actuator map"
                                                                        : "actuator map's description";
      throw Error(other.name(),
                  fmt::format("its {}{} differs from that of {}", what,
                              person == 0 ? "" : fmt::format(" of person {}", person + 1), first.name()),
                  kOneRecording);
    }
}

void require_same_version(const std::optional<int>& known, const TraceIndex& added, const ByteSource& first,
                          const ByteSource& other) {
  const std::optional<int> own = added.streams.version_of_schemas();
  if (!known || !own || *known == *own) return;
  throw Error(other.name(),
              fmt::format("has format version {}, and {} has {}: 1 is of points, 2 of colliders with radii, 3 of "
                          "several people or colliders that belong to people",
                          *own, first.name(), *known),
              kOneRecording);
}

/// Returns the keys that only one session has, or whose values differ.
std::vector<std::string> differing_keys(const Session& a, const Session& b) {
  std::set<std::string> keys;
  for (const auto& [one, other] : {std::tie(a, b), std::tie(b, a)})
    for (const auto& [key, value] : one)
      if (const auto found = other.find(key); found == other.end() || found->second != value) keys.insert(key);
  return {keys.begin(), keys.end()};
}

struct Common {
  Definitions definitions;  ///< all definitions of the parts
  std::vector<Merged::OtherSession> other_sessions;
};

/// Checks that the sources are parts of one recording.
Common find_common(const std::vector<std::unique_ptr<ByteSource>>& sources) {
  const ByteSource& first = *sources.front();
  std::optional<Identity> identity;
  Session session;
  std::optional<int> version;
  Common common;
  Definitions& all = common.definitions;
  for (const auto& source : sources) {
    mcap::require_mcap(*source);
    Definitions definitions = gather_definitions(*source);
    if (!is_trace(definitions))
      throw Error(source->name(), "is not a trace of vestige: it has no channel /pose", "merge only traces");
    TraceIndex index = index_trace(*source);
    const Identity own = identity_of(index);
    if (!identity) {
      identity = own;
      version = index.streams.version_of_schemas();
      session = std::move(index.session);
      all = std::move(definitions);
      continue;
    }
    require_same(*identity, own, first, *source);
    // Parts of one recording have the same session, even the same start time. A damaged session says nothing.
    std::vector<std::string> keys = differing_keys(session, index.session);
    if (!keys.empty() && !session.empty() && !index.session.empty())
      common.other_sessions.push_back({.file = source->name(), .keys = std::move(keys)});
    require_same_version(version, index, first, *source);
    require_same(all.schemas, definitions.schemas, "schema", first, *source);
    require_same(all.channels, definitions.channels, "channel", first, *source);
    all.schemas.merge(definitions.schemas);
    all.channels.merge(definitions.channels);
  }
  return common;
}

/// Compares the messages of two files at one moment, which may not fit into memory.
class Fingerprint {
 public:
  void add(const mcap::Message& message) {
    record_.clear();
    mcap::append_record(record_, message);
    sha_.update(record_);
    ++messages_;
  }
  std::uint64_t messages() const { return messages_; }
  bool operator==(const Fingerprint& other) const { return sha_.hex() == other.sha_.hex(); }

 private:
  Sha256 sha_;
  std::uint64_t messages_ = 0;
  mcap::ByteBuffer record_;
};

/// One of the files, read message by message. All other records go to `take_other`.
class Part {
 public:
  explicit Part(const ByteSource& source) : source_(source), reader_(source) {}

  template <typename TakeOther>
  void advance(TakeOther take_other) {
    mcap::StreamRecord record;
    head_.reset();
    while (reader_.next(record)) {
      share_ = static_cast<double>(record.offset) / static_cast<double>(source_.size());
      if (record.opcode == Opcode::kMessage) {
        head_ = mcap::decode_message(record.content);
        return;
      }
      take_other(record);
    }
    share_ = 1;
  }

  const std::optional<mcap::Message>& head() const { return head_; }
  bool is_at(const Moment& moment) const { return head_ && moment_of(*head_) == moment; }
  const ByteSource& source() const { return source_; }
  double share() const { return share_; }
  mcap::DamageList damages() const { return reader_.damages(); }

 private:
  const ByteSource& source_;
  mcap::StreamReader reader_;
  std::optional<mcap::Message> head_;  ///< its data belong to the reader
  double share_ = 0;
};

class Merger {
 public:
  Merger(const std::vector<std::unique_ptr<ByteSource>>& sources, const mcap::Writer::Sink& sink,
         const Definitions& definitions)
      : output_(sink, std::string(trace_format::kProfile), definitions.compression.value_or(mcap::Compression::kZstd),
                definitions) {
    for (const auto& source : sources) parts_.push_back(std::make_unique<Part>(*source));
  }

  Merged run(const std::function<bool(double)>& progress);

 private:
  void advance(Part& part);
  void take_other(const mcap::StreamRecord& record);
  const Part& take_moment(const Moment& moment);
  template <typename Take>
  void take_group(Part& part, const Moment& moment, Take take);
  bool is_ours(const mcap::Message& message) const;
  void write(const mcap::Message& message, const Part& part);
  void require_next_frame(std::uint32_t sequence, const Part& part);
  double share() const;

  McapOutput output_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::set<std::string> written_;  ///< SHA-256 of attachments and metadata
  std::optional<std::uint32_t> last_frame_;
  std::set<std::size_t> posed_;  ///< the people whose pose was written at this moment
  Merged result_;
};

Merged Merger::run(const std::function<bool(double)>& progress) {
  for (const auto& part : parts_) advance(*part);
  for (;;) {
    std::optional<Moment> next;
    for (const auto& part : parts_)
      if (part->head() && (!next || moment_of(*part->head()) < *next)) next = moment_of(*part->head());
    if (!next) break;
    const Part& from = take_moment(*next);
    output_.end_full_chunk();
    if (!progress(share())) throw Error(from.source().name(), "merging was stopped; nothing was written", "");
  }
  output_.write_definitions();
  output_.finish();
  result_.messages = output_.statistics().message_count;
  for (const auto& part : parts_)
    if (mcap::DamageList damages = part->damages(); !damages.empty())
      result_.damages.push_back({.file = part->source().name(), .list = std::move(damages)});
  return std::move(result_);
}

double Merger::share() const {
  double sum = 0;
  for (const auto& part : parts_) sum += part->share();
  return sum / static_cast<double>(parts_.size());
}

void Merger::advance(Part& part) {
  part.advance([this](const mcap::StreamRecord& record) { take_other(record); });
}

void Merger::take_other(const mcap::StreamRecord& record) {
  try {
    if (record.opcode == Opcode::kSchema) output_.add(mcap::decode_schema(record.content));
    if (record.opcode == Opcode::kChannel) output_.add(mcap::decode_channel(record.content));
    if (record.opcode == Opcode::kMetadata && written_.insert(sha256_hex(record.content)).second)
      output_.write(mcap::decode_metadata(record.content));
    if (record.opcode != Opcode::kAttachment) return;
    const mcap::Attachment attachment = mcap::decode_attachment(record.content);
    if (mcap::attachment_crc_holds(record.content, attachment) && written_.insert(sha256_hex(record.content)).second)
      output_.write(attachment);
  } catch (const Malformed&) {
    return;  // the reader notes records whose fields do not fit
  }
}

/// Writes the messages that the first file with this moment has, and returns that file. Vestige's own messages must be
/// the same in the other files. Foreign messages may differ, because each file's first frame has its own /viz.
const Part& Merger::take_moment(const Moment& moment) {
  const bool is_shared = std::ranges::count_if(parts_, [&](const auto& part) { return part->is_at(moment); }) > 1;
  const Part* from = nullptr;
  Fingerprint frame;
  posed_.clear();
  for (const auto& part : parts_) {
    if (!part->is_at(moment)) continue;
    if (from == nullptr) {
      from = part.get();
      take_group(*part, moment, [&](const mcap::Message& message) {
        write(message, *from);
        if (is_shared && is_ours(message)) frame.add(message);
      });
      continue;
    }
    Fingerprint twin;
    take_group(*part, moment, [&](const mcap::Message& message) {
      if (is_ours(message)) twin.add(message);
    });
    if (!(twin == frame))
      throw Error(part->source().name(),
                  fmt::format("its frame {} (at {} ns) differs from that of {}", moment.sequence, moment.time_ns,
                              from->source().name()),
                  kOneRecording);
    result_.duplicates += twin.messages();
  }
  return *from;
}

/// Passes all messages of one moment, which are consecutive in a file, to `take` one by one.
template <typename Take>
void Merger::take_group(Part& part, const Moment& moment, Take take) {
  while (part.is_at(moment)) {
    take(*part.head());
    advance(part);
  }
}

bool Merger::is_ours(const mcap::Message& message) const {
  return output_.streams().stream_of(message.channel_id) != Stream::kForeign;
}

void Merger::require_next_frame(std::uint32_t sequence, const Part& part) {
  if (last_frame_ && sequence <= *last_frame_)
    throw Error(part.source().name(),
                fmt::format("in order of time, its frame {} comes after frame {}", sequence, *last_frame_),
                kOneRecording);
  if (last_frame_) result_.missing_frames += sequence - *last_frame_ - 1;
  last_frame_ = sequence;
  ++result_.frames;
}

void Merger::write(const mcap::Message& message, const Part& part) {
  if (output_.streams().stream_of(message.channel_id) == Stream::kPose) {
    const bool is_second = !posed_.insert(output_.streams().person_of(message.channel_id)).second;
    if (is_second || posed_.size() == 1) require_next_frame(message.sequence, part);
  }
  if (!output_.write(message))
    throw Error(part.source().name(),
                fmt::format("it has messages of channel {}, which is not defined", message.channel_id),
                "run `vestige recover` on it first");
}

}  // namespace

Merged merge_traces(const std::vector<std::unique_ptr<ByteSource>>& sources, const mcap::Writer::Sink& sink,
                    const std::function<bool(double)>& progress) {
  Common common = find_common(sources);
  Merged merged = Merger(sources, sink, common.definitions).run(progress);
  merged.other_sessions = std::move(common.other_sessions);
  return merged;
}

}  // namespace vestige
