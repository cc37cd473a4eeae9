#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "traces/files/scratch_file.hpp"

namespace vestige {

/// Turns rows into columns: takes a row at a time and gives back a column at a time, for tables larger than memory.
/// Holds 16 MiB or one row, whichever is more.
class ColumnFile {
 public:
  /// `widths`: floats of each column in a row. `beside`: as for `ScratchFile`.
  ColumnFile(const std::filesystem::path& beside, std::vector<std::size_t> widths);

  /// The next row: the floats of all columns, one column behind the other.
  void append(std::span<const float> row);

  std::uint64_t rows() const { return rows_; }
  std::size_t width(std::size_t column) const { return widths_[column]; }

  /// Hands over all of a column, block after block. `finish` must have been called.
  void read(std::size_t column, const std::function<void(std::span<const float>)>& take) const;
  void finish();

 private:
  void flush();

  ScratchFile file_;
  std::vector<std::size_t> widths_;
  std::vector<std::size_t> starts_;  ///< of each column in a row
  std::size_t row_floats_ = 0;
  std::size_t block_rows_ = 0;
  std::vector<float> block_;  ///< rows that wait
  std::size_t waiting_ = 0;
  std::uint64_t rows_ = 0;
};

}  // namespace vestige
