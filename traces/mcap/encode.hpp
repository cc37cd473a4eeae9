#pragma once

#include <vector>

#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Bytes being assembled. Cleared and reused, to keep the allocation.
using ByteBuffer = std::vector<std::byte>;

// Each function appends one whole record (opcode, length, content) to `out`. Throws std::length_error if a string or
// map has 4 GiB or more.
void append_record(ByteBuffer& out, const Header& record);
void append_record(ByteBuffer& out, const Footer& record);
void append_record(ByteBuffer& out, const Schema& record);
void append_record(ByteBuffer& out, const Channel& record);
void append_record(ByteBuffer& out, const Message& record);
void append_record(ByteBuffer& out, const Chunk& record);
void append_record(ByteBuffer& out, const MessageIndex& record);
void append_record(ByteBuffer& out, const ChunkIndex& record);
void append_record(ByteBuffer& out, const AttachmentIndex& record);
void append_record(ByteBuffer& out, const Statistics& record);
void append_record(ByteBuffer& out, const Metadata& record);
void append_record(ByteBuffer& out, const MetadataIndex& record);
void append_record(ByteBuffer& out, const SummaryOffset& record);
void append_record(ByteBuffer& out, const DataEnd& record);

/// Appends an attachment's record up to its data. The data may be large, so the caller writes them directly from where
/// they are. After the data comes `append_attachment_crc`.
void append_attachment_head(ByteBuffer& out, const Attachment& attachment);

/// Appends the CRC that ends an attachment's record; it covers the content before it. `head` is the output of
/// `append_attachment_head`.
void append_attachment_crc(ByteBuffer& out, Bytes head, Bytes data);

void append_magic(ByteBuffer& out);

}  // namespace vestige::mcap
