#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "traces/mcap/findings.hpp"

namespace vestige::mcap {

/// A fault in a file, and its consequence.
struct Problem {
  std::uint64_t offset = 0;  ///< in the file: start of the record or chunk, or the first lost byte
  std::uint64_t bytes = 0;   ///< number of affected bytes from `offset` on
  std::optional<std::uint64_t> offset_in_chunk = {};  ///< of a record, from the start of its chunk's expanded records
  std::string what;                                   ///< "Chunk: its CRC is wrong"
  std::string consequence;                            ///< "its messages are not read"
};

using ProblemList = Findings<Problem>;

}  // namespace vestige::mcap
