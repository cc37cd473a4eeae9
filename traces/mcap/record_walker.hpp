#pragma once

#include <optional>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/findings.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// kBehindEnd, kAnotherFile: what stands behind the file's end is not read; the latter begins as an MCAP file does.
enum class DamageEffect { kLost, kMended, kBehindEnd, kAnotherFile };

/// A place in a file where something is wrong, and how much of the file it takes with it.
struct Damage {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::string what;  ///< "a Chunk: its CRC is wrong"
  DamageEffect effect = DamageEffect::kLost;
};

using DamageList = Findings<Damage>;

/// Where a record stands in its file.
struct RecordPlace {
  Opcode opcode = Opcode::kMessage;
  std::uint64_t offset = 0;         ///< of its opcode
  std::uint64_t content_bytes = 0;  ///< what its length field says, unless that is broken; always within the file
  std::uint64_t content_offset() const { return offset + kRecordHeadBytes; }
  std::uint64_t end() const { return content_offset() + content_bytes; }
};

/// Whether a file must begin with MCAP's magic bytes; where they may be broken, what follows is looked for.
enum class MagicBytes { kRequired, kMayBeBroken };

/// Steps from record to record in the order of the file, without looking into chunks, and finds its way back when a
/// length or opcode is broken.
///
/// A length has no CRC, so a record is believed when the bytes after it look like the head of another (nine bytes of
/// which at least four must be zero), or when its own fields fill it exactly. Where they do not, but its fields end
/// just before a known record, its length is what is broken: that is noted as damage and mended. Otherwise everything
/// up to the next believable records, the first of which must be filled by its fields, is skipped and noted as damage.
/// Messages are resynchronised on only in files without chunks: inside a broken chunk no CRC would vouch for them.
/// Takes linear time and some 100 KiB whatever the bytes.
class RecordWalker {
 public:
  /// Throws `Error` when the source is empty or does not begin with the magic bytes that it needs. `source` must stay.
  explicit RecordWalker(const ByteSource& source, MagicBytes magic = MagicBytes::kRequired);

  /// False at the end: after a footer, or where the file was cut.
  bool next(RecordPlace& place);
  /// The record's content, in `buffer`.
  Bytes content(const RecordPlace& place, RawBuffer& buffer) const;

  bool footer_seen() const { return footer_seen_; }
  /// Where the next record is expected.
  std::uint64_t position() const { return position_; }
  /// What the last call of `next` found wrong on its way; the first call adds what is wrong with the file's beginning.
  const std::vector<Damage>& damages() const { return damages_; }

 private:
  std::optional<RecordPlace> head_at(ReadWindow& window, std::uint64_t offset) const;
  Opcode opcode_at(std::uint64_t offset);
  bool could_follow(std::uint64_t offset, Opcode before);
  bool stands_at(std::uint64_t offset);
  std::optional<std::uint64_t> natural_bytes(Opcode opcode, std::uint64_t content_offset, std::uint64_t limit);
  bool fills_itself(const RecordPlace& place);
  bool mend(RecordPlace& place);
  bool may_resume_at(const RecordPlace& place, bool messages_too);
  bool resynchronise();
  void begin_without_magic();
  void note_bytes_behind(std::uint64_t end);
  void finish(std::uint64_t end);

  const ByteSource& source_;
  ReadWindow here_;
  ReadWindow ahead_;  ///< apart, so that looking ahead does not make `here_` read its bytes again
  RawBuffer scratch_;
  std::uint64_t looked_at_bytes_ = 0;  ///< to tell where fields end; limited, so that lies cost linear time
  std::uint64_t position_ = kMagicBytes;
  bool chunk_seen_ = false;
  bool footer_seen_ = false;
  bool ended_ = false;
  bool begun_ = false;  ///< `next` has been called
  std::vector<Damage> damages_;
};

/// Throws `Error` unless `source` begins with MCAP's magic bytes.
void require_mcap(const ByteSource& source);

}  // namespace vestige::mcap
