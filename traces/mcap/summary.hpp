#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// The content of a file's summary section and footer.
struct Summary {
  std::optional<Header> header;  ///< read from the file's beginning
  Footer footer;
  std::uint64_t data_section_end = 0;  ///< start of the summary, or of the footer if there is no summary
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  std::optional<Statistics> statistics;
  std::vector<ChunkIndex> chunk_indexes;  ///< by offset, like the next two lists; each in the data section
  std::vector<AttachmentIndex> attachment_indexes;
  std::vector<MetadataIndex> metadata_indexes;
};

/// A summary, or the reason why there is no trustworthy one.
struct SummaryResult {
  std::optional<Summary> summary;
  std::string problem;  ///< "its last bytes are not a footer", …
};

/// Reads a file's footer and summary section. Returns an empty summary for a file that has a footer but no summary
/// section. Throws `Error` if the file is not an MCAP file.
SummaryResult read_summary(const ByteSource& source);

/// Whether the summary's indexes list every chunk, attachment and metadata record of the data section exactly once, and
/// no message stands outside chunks. Reads the head of every record of the data section that is not in a chunk.
bool leads_to_everything(const ByteSource& source, const Summary& summary);

/// Reads the whole record at `offset` and returns its content, which lies in `buffer`. Throws `Malformed` if another
/// kind of record stands there, or the record extends past `limit` (an offset in the file).
Bytes read_record_at(const ByteSource& source, std::uint64_t offset, Opcode expected, std::uint64_t limit,
                     RawBuffer& buffer);

}  // namespace vestige::mcap
