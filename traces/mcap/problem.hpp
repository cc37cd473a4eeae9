#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vestige::mcap {

/// Something wrong with a file, and what follows from it.
struct Problem {
  std::uint64_t offset = 0;  ///< in the file: of the record, of the chunk, of the first lost byte
  std::uint64_t bytes = 0;   ///< that are concerned, from there on
  std::optional<std::uint64_t> offset_in_chunk = {};  ///< of a record, from the start of its chunk's expanded records
  std::string what;                                   ///< "Chunk: its CRC is wrong"
  std::string consequence;                            ///< "none of its messages is read"
};

/// Counts every problem and keeps the first of them, so that a file made of problems costs no memory.
class ProblemList {
 public:
  static constexpr std::size_t kMostKept = 1000;

  void add(Problem problem) {
    ++count_;
    if (kept_.size() < kMostKept) kept_.push_back(std::move(problem));
  }
  std::uint64_t count() const { return count_; }
  const std::vector<Problem>& kept() const { return kept_; }

 private:
  std::uint64_t count_ = 0;
  std::vector<Problem> kept_;
};

}  // namespace vestige::mcap
