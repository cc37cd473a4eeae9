#pragma once

#include <vector>

#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Bytes being put together; cleared and used again to keep its memory.
using ByteBuffer = std::vector<std::byte>;

// Each appends one whole record (opcode, length, content) to `out`. A string or map of 4 GiB or more throws
// std::length_error.
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

/// An attachment's record up to its data, which may be large and is written from where it is; after the data follows
/// `append_attachment_crc`.
void append_attachment_head(ByteBuffer& out, const Attachment& attachment);

/// The CRC that ends an attachment's record, over the content before it. `head` is what `append_attachment_head` made.
void append_attachment_crc(ByteBuffer& out, Bytes head, Bytes data);

void append_magic(ByteBuffer& out);

}  // namespace vestige::mcap
