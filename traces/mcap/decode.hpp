#pragma once

#include <bit>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "traces/mcap/record.hpp"

namespace vestige::mcap {

static_assert(std::endian::native == std::endian::little,
              "MCAP is little-endian, and so is every machine we build for");

/// Thrown if bytes are not what they claim to be. A caller that knows file and offset turns it into an `Error` or a
/// `Damage`.
class Malformed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads consecutive little-endian fields. Throws `Malformed` instead of reading past the end of the bytes.
class Cursor {
 public:
  explicit Cursor(Bytes bytes) : rest_(bytes) {}

  template <typename Number>
  Number number() {
    Number value = 0;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  Bytes bytes(std::uint64_t count) {
    if (count > rest_.size()) throw Malformed("a field reaches beyond its record");
    const Bytes taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return taken;
  }
  std::string_view string() {
    const Bytes text = bytes(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(text.data()), text.size()};
  }
  std::size_t remaining() const { return rest_.size(); }

 private:
  Bytes rest_;
};

// Each function decodes the content of one record (without opcode and length). Bytes after the known fields are
// ignored, as the specification asks. Throws `Malformed`. Uses at most a small multiple of the memory of `content`.
Header decode_header(Bytes content);
Footer decode_footer(Bytes content);
Schema decode_schema(Bytes content);
Channel decode_channel(Bytes content);
Message decode_message(Bytes content);
Chunk decode_chunk(Bytes content);
MessageIndex decode_message_index(Bytes content);
ChunkIndex decode_chunk_index(Bytes content);
Attachment decode_attachment(Bytes content);
AttachmentIndex decode_attachment_index(Bytes content);
Statistics decode_statistics(Bytes content);
Metadata decode_metadata(Bytes content);
MetadataIndex decode_metadata_index(Bytes content);
SummaryOffset decode_summary_offset(Bytes content);
DataEnd decode_data_end(Bytes content);

/// Whether the CRC of the attachment with this record content matches, or the attachment has no CRC.
bool attachment_crc_holds(Bytes content, const Attachment& attachment);

/// Returns the least number of content bytes of such a record, or nothing if the specification does not define the
/// opcode.
std::optional<std::size_t> least_content_bytes(Opcode opcode);

/// Returns how many bytes of `content` the fields in the specification occupy. Returns nothing if the fields do not
/// fit, or if this kind of record does not tell (messages and unknown kinds).
std::optional<std::size_t> natural_content_bytes(Opcode opcode, Bytes content);

/// One record inside a chunk or a summary.
struct InnerRecord {
  Opcode opcode = Opcode::kMessage;
  Bytes content;
};
InnerRecord next_record(Cursor& cursor);

/// Whether the fields of a record fit into its content. Precondition: `belongs_in_chunks(record.opcode)`.
bool fits_its_fields(const InnerRecord& record);

}  // namespace vestige::mcap
