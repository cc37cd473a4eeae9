#include "traces/mcap/record_walker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

namespace {

constexpr std::uint64_t kFieldBytes = 1 << 16;  ///< records other than chunks and attachments are rarely larger
constexpr std::uint64_t kHeadBytes = 1 << 12;   ///< what chunks and attachments have before their data is rarely larger
constexpr std::uint64_t kMostLookedAtBytes = 64ULL << 20;  ///< plus the number of bytes before this place in the file

bool is_known(Opcode opcode) {
  return least_content_bytes(opcode).has_value();
}

/// Whether the source begins with the magic bytes, or with as many of them as it has bytes.
bool begins_with_magic(const ByteSource& source) {
  std::array<std::byte, kMagicBytes> magic = {};
  const auto begin =
      std::span(magic).first(static_cast<std::size_t>(std::min<std::uint64_t>(source.size(), kMagicBytes)));
  source.read_at(0, begin);
  return is_magic(begin);
}

/// Whether records of this kind hold only a few numbers and at most a name.
bool is_always_short(Opcode opcode) {
  return opcode == Opcode::kDataEnd || opcode == Opcode::kAttachmentIndex || opcode == Opcode::kMetadataIndex ||
         opcode == Opcode::kSummaryOffset;
}

void require_content(const ByteSource& source) {
  if (source.size() == 0)
    throw Error(source.name(), "is empty", "check that its recording started, and that the disk is not full");
}

}  // namespace

void require_mcap(const ByteSource& source) {
  require_content(source);
  if (!begins_with_magic(source))
    throw Error(source.name(), "is not an MCAP file: it does not begin with MCAP's magic bytes",
                "name a recorded trace; if this file is one, `vestige recover` may still read it");
  if (source.size() < kMagicBytes) throw Error(source.name(), "ends inside MCAP's magic bytes", "record it again");
}

RecordWalker::RecordWalker(const ByteSource& source, MagicBytes magic)
    : source_(source), here_(source), ahead_(source) {
  if (magic == MagicBytes::kRequired) {
    require_mcap(source);
    return;
  }
  require_content(source);
  if (source.size() < kMagicBytes || !begins_with_magic(source)) begin_without_magic();
}

void RecordWalker::begin_without_magic() {
  const auto header = head_at(here_, kMagicBytes);
  if (header && header->opcode == Opcode::kHeader && may_resume_at(*header, false)) {
    damages_.push_back({0, kMagicBytes, "the magic bytes at the beginning of the file are broken"});
  } else {
    damages_.push_back({0, 0, "the file does not begin with MCAP's magic bytes"});
    position_ = 0;
  }
}

std::optional<RecordPlace> RecordWalker::head_at(ReadWindow& window, std::uint64_t offset) const {
  if (offset > source_.size() || source_.size() - offset < kRecordHeadBytes) return {};
  const Bytes head = window.at(offset, kRecordHeadBytes);
  RecordPlace place{.opcode = static_cast<Opcode>(head[0]), .offset = offset, .content_bytes = 0};
  std::memcpy(&place.content_bytes, head.data() + 1, sizeof place.content_bytes);
  const auto least = least_content_bytes(place.opcode);
  if (head[0] == std::byte{0} || place.content_bytes < least.value_or(0) || place.content_bytes > kMaxRecordBytes)
    return {};
  if (place.opcode == Opcode::kHeader && offset != kMagicBytes) return {};
  if (place.opcode == Opcode::kFooter && place.content_bytes != kFooterContentBytes) return {};
  return place;
}

Opcode RecordWalker::opcode_at(std::uint64_t offset) {
  return static_cast<Opcode>(here_.at(offset, 1)[0]);
}

/// Whether a record may begin at `offset`. The end of the file also counts, because a file can be cut anywhere.
bool RecordWalker::could_follow(std::uint64_t offset, Opcode before) {
  const std::uint64_t rest = source_.size() - offset;
  if (before == Opcode::kFooter)
    return is_magic(ahead_.at(offset, static_cast<std::size_t>(std::min<std::uint64_t>(rest, kMagicBytes))));
  if (rest == 0) return true;
  if (rest < kRecordHeadBytes) return is_known(static_cast<Opcode>(ahead_.at(offset, 1)[0]));
  const auto head = head_at(ahead_, offset);
  return head && (is_known(head->opcode) || head->end() <= source_.size());
}

/// Returns how many bytes the fields of a record occupy, if it has at most `limit` bytes. Returns nothing if they do
/// not tell.
std::optional<std::uint64_t> RecordWalker::natural_bytes(Opcode opcode, std::uint64_t content_offset,
                                                         std::uint64_t limit) {
  const bool large = opcode == Opcode::kChunk || opcode == Opcode::kAttachment;
  const std::uint64_t rest = std::min(limit, source_.size() - content_offset);
  const std::uint64_t count = std::min(rest, large ? kHeadBytes : kFieldBytes);
  if (looked_at_bytes_ + count > kMostLookedAtBytes + content_offset) return {};
  looked_at_bytes_ += count;
  source_.read_at(content_offset, scratch_.reset(static_cast<std::size_t>(count)));
  const Bytes content = scratch_.bytes();
  try {
    Cursor cursor(content);
    std::uint64_t behind_data = 0;
    if (opcode == Opcode::kChunk) {
      cursor.bytes(8 + 8 + 8 + 4);  // times, size, CRC
      cursor.string();              // compression
    } else if (opcode == Opcode::kAttachment) {
      cursor.bytes(8 + 8);  // times
      cursor.string();      // name
      cursor.string();      // media type
      behind_data = 4;      // CRC
    } else {
      return natural_content_bytes(opcode, content);
    }
    const auto data_bytes = cursor.number<std::uint64_t>();
    const std::uint64_t before_data = count - cursor.remaining();
    if (data_bytes > rest || before_data + behind_data > rest - data_bytes) return {};
    return before_data + data_bytes + behind_data;
  } catch (const Malformed&) {
    return {};
  }
}

bool RecordWalker::fills_itself(const RecordPlace& place) {
  return natural_bytes(place.opcode, place.content_offset(), place.content_bytes) == place.content_bytes;
}

/// Whether a record certainly stands at `offset`. The specification must define its kind, and its length must match its
/// fields. If its fields do not tell the length, another record must follow.
bool RecordWalker::stands_at(std::uint64_t offset) {
  const auto head = head_at(ahead_, offset);
  if (!head || !is_known(head->opcode) || head->end() > source_.size()) return false;
  if (head->opcode == Opcode::kMessage || head->opcode == Opcode::kFooter)
    return could_follow(head->end(), head->opcode);
  return fills_itself(*head);
}

/// If the record's own fields end elsewhere, and just before another record, corrects the record's length to that end.
bool RecordWalker::mend(RecordPlace& place) {
  const bool tells = is_known(place.opcode) && place.opcode != Opcode::kMessage && place.opcode != Opcode::kFooter;
  if (!tells || source_.size() - place.offset < kRecordHeadBytes || fills_itself(place)) return false;
  const auto natural = natural_bytes(place.opcode, place.content_offset(), source_.size());
  if (!natural || *natural == place.content_bytes) return false;
  const std::uint64_t end = place.content_offset() + *natural;
  if (!stands_at(end)) return false;
  damages_.push_back(
      {place.offset + 1, kRecordHeadBytes - 1,
       fmt::format("the length of a {} is broken; its fields tell where it ends", mcap::name_of(place.opcode)),
       DamageEffect::kMended});
  place.content_bytes = *natural;
  return true;
}

/// Uses a few record heads and a limited number of looks at fields, so that resynchronising takes linear time even if
/// every length in the file is forged.
bool RecordWalker::may_resume_at(const RecordPlace& place, bool messages_too) {
  if (!is_known(place.opcode) || place.end() > source_.size()) return false;
  if (belongs_in_chunks(place.opcode) && !messages_too) return false;
  if (is_always_short(place.opcode) && place.content_bytes > 4096) return false;
  if (!could_follow(place.end(), place.opcode)) return false;
  const bool tells = place.opcode != Opcode::kMessage && place.content_bytes <= kFieldBytes &&
                     looked_at_bytes_ + kFieldBytes <= kMostLookedAtBytes + place.offset;
  if (tells && !fills_itself(place)) return false;
  if (place.end() == source_.size() || place.opcode == Opcode::kFooter) return true;
  const auto second = head_at(ahead_, place.end());
  if (!second) return true;
  // In a file whose messages are in chunks, messages follow nothing outside chunks. This place would be in the middle
  // of a chunk that was cut.
  if (belongs_in_chunks(second->opcode) && !messages_too) return false;
  return second->end() > source_.size() || could_follow(second->end(), second->opcode);
}

bool RecordWalker::resynchronise() {
  const std::uint64_t broken = position_;
  const auto head = head_at(here_, broken);
  const bool messages_too = !chunk_seen_ && !(head && head->opcode == Opcode::kChunk);
  for (std::uint64_t offset = broken + 1; offset + kRecordHeadBytes <= source_.size(); ++offset) {
    const auto place = head_at(here_, offset);
    if (!place || !may_resume_at(*place, messages_too)) continue;
    damages_.push_back({broken, offset - broken, "a record whose length or kind is broken"});
    position_ = offset;
    return true;
  }
  const std::uint64_t rest = source_.size() - broken;
  if (head && is_known(head->opcode) && head->end() > source_.size()) {
    damages_.push_back({broken, rest, fmt::format("the file ends inside this {}", mcap::name_of(head->opcode))});
  } else if (rest < kRecordHeadBytes) {
    damages_.push_back({broken, rest, "the file ends inside a record"});
  } else {
    damages_.push_back({broken, rest, "no record can be found from here to the end"});
  }
  return false;
}

void RecordWalker::finish(std::uint64_t end) {
  ended_ = true;
  footer_seen_ = true;
  const std::uint64_t rest = source_.size() - end;
  const auto magic = static_cast<std::size_t>(std::min<std::uint64_t>(rest, kMagicBytes));
  if (magic < kMagicBytes || !is_magic(ahead_.at(end, magic)))
    damages_.push_back({end, rest, "the magic bytes at the end of the file are cut off or broken"});
  else if (rest > kMagicBytes)
    note_bytes_behind(end + kMagicBytes);
}

void RecordWalker::note_bytes_behind(std::uint64_t end) {
  const std::uint64_t rest = source_.size() - end;
  if (rest > kMagicBytes && is_magic(ahead_.at(end, kMagicBytes)))
    damages_.push_back(
        {end, rest, "the file ends here; a second MCAP file follows, which is not read", DamageEffect::kAnotherFile});
  else
    damages_.push_back(
        {end, rest, "the file ends here; more bytes follow, which are not read", DamageEffect::kBehindEnd});
}

bool RecordWalker::next(RecordPlace& place) {
  if (std::exchange(begun_, true)) damages_.clear();
  while (!ended_) {
    if (position_ == source_.size()) {
      damages_.push_back({position_, 0, "the file ends without a footer"});
      break;
    }
    const auto head = head_at(here_, position_);
    const bool fits = head && head->end() <= source_.size();
    const bool believable = fits && (could_follow(head->end(), head->opcode) || fills_itself(*head));
    place = head.value_or(RecordPlace{.opcode = opcode_at(position_), .offset = position_});
    if (!mend(place) && !believable) {
      if (!resynchronise()) break;
      continue;
    }
    position_ = place.end();
    if (place.opcode == Opcode::kChunk) chunk_seen_ = true;
    if (place.opcode == Opcode::kFooter) finish(position_);
    return true;
  }
  ended_ = true;
  return false;
}

Bytes RecordWalker::content(const RecordPlace& place, RawBuffer& buffer) const {
  source_.read_at(place.content_offset(), buffer.reset(static_cast<std::size_t>(place.content_bytes)));
  return buffer.bytes();
}

}  // namespace vestige::mcap
