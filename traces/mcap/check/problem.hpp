#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "traces/mcap/findings.hpp"

namespace vestige::mcap {

/// Something wrong with a file, and what follows from it.
struct Problem {
  std::uint64_t offset = 0;  ///< in the file: of the record, of the chunk, of the first lost byte
  std::uint64_t bytes = 0;   ///< that are concerned, from there on
  std::optional<std::uint64_t> offset_in_chunk = {};  ///< of a record, from the start of its chunk's expanded records
  std::string what;                                   ///< "Chunk: its CRC is wrong"
  std::string consequence;                            ///< "none of its messages is read"
};

using ProblemList = Findings<Problem>;

}  // namespace vestige::mcap
