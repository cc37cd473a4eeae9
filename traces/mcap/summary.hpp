#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// What the end of a file says about the rest of it.
struct Summary {
  std::optional<Header> header;  ///< from the file's beginning
  Footer footer;
  std::uint64_t data_section_end = 0;  ///< where the summary begins, or the footer
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  std::optional<Statistics> statistics;
  std::vector<ChunkIndex> chunk_indexes;  ///< by offset, as the next two; each lies within the data section
  std::vector<AttachmentIndex> attachment_indexes;
  std::vector<MetadataIndex> metadata_indexes;
};

/// A summary, or the reason why there is none that can be trusted.
struct SummaryResult {
  std::optional<Summary> summary;
  std::string problem;  ///< "it has no footer", …
};

/// Reads a file's footer and summary section. A file without summary section but with a footer has an empty summary.
/// Throws `Error` when it is no MCAP file at all.
SummaryResult read_summary(const ByteSource& source);

/// Whether the summary's indexes lead to every chunk, attachment and metadata of the data section, each once, and no
/// message stands outside chunks. Looks at the head of every record there that is not in a chunk.
bool leads_to_everything(const ByteSource& source, const Summary& summary);

/// Reads the whole record at `offset`, whose content is returned in `buffer`. Throws `Malformed` when there is another
/// kind of record, or it reaches beyond `limit` (an offset in the file).
Bytes read_record_at(const ByteSource& source, std::uint64_t offset, Opcode expected, std::uint64_t limit,
                     RawBuffer& buffer);

}  // namespace vestige::mcap
