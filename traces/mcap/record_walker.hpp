#pragma once

#include <optional>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/findings.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// kBehindEnd, kAnotherFile: bytes after the file's end, which are not read. kAnotherFile: those bytes begin with
/// MCAP's magic bytes.
enum class DamageEffect { kLost, kMended, kBehindEnd, kAnotherFile };

/// A damaged place in a file, and how many bytes are affected.
struct Damage {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::string what;  ///< "a Chunk: its CRC is wrong"
  DamageEffect effect = DamageEffect::kLost;
};

using DamageList = Findings<Damage>;

/// The place of a record in its file.
struct RecordPlace {
  Opcode opcode = Opcode::kMessage;
  std::uint64_t offset = 0;         ///< of its opcode
  std::uint64_t content_bytes = 0;  ///< the length field, corrected if it is broken; always within the file
  std::uint64_t content_offset() const { return offset + kRecordHeadBytes; }
  std::uint64_t end() const { return content_offset() + content_bytes; }
};

/// Whether a file must begin with MCAP's magic bytes. kMayBeBroken: if they are broken, the first record is searched
/// for.
enum class MagicBytes { kRequired, kMayBeBroken };

/// Steps from record to record in file order, without looking into chunks. Finds the next record again after a broken
/// length or opcode.
///
/// A length has no CRC. So a record is accepted if the bytes after it look like the head of another record (nine bytes,
/// of which at least four must be zero), or if its own fields fill it exactly. If they do not, but its fields end just
/// before a known record, then its length is what is broken: the walker corrects the length and notes the damage.
/// Otherwise the walker skips to the next acceptable records, of which the first must be filled exactly by its fields,
/// and notes the skipped bytes as damage. It resumes at a message only in files without chunks, because inside a broken
/// chunk no CRC protects the messages. Takes linear time and some 100 KiB, whatever the bytes are.
class RecordWalker {
 public:
  /// Keeps a reference to `source`. Throws `Error` if the source is empty, or lacks the magic bytes although they are
  /// required.
  explicit RecordWalker(const ByteSource& source, MagicBytes magic = MagicBytes::kRequired);

  /// Finds the next record. Returns false at the end: after a footer, or where the file was cut.
  bool next(RecordPlace& place);
  /// Reads the record's content into `buffer` and returns it.
  Bytes content(const RecordPlace& place, RawBuffer& buffer) const;

  bool footer_seen() const { return footer_seen_; }
  /// Where the next record is expected.
  std::uint64_t position() const { return position_; }
  /// Damage that the last call of `next` found. The first call adds damage at the beginning of the file.
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
  ReadWindow ahead_;  ///< a second window, so that looking ahead does not evict the bytes of `here_`
  RawBuffer scratch_;
  std::uint64_t looked_at_bytes_ = 0;  ///< read to find field ends; limited, so that forged lengths cost linear time
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
