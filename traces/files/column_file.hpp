#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "traces/files/scratch_file.hpp"

namespace vestige {

/// Transposes tables larger than memory: takes one row at a time and returns one column at a time. Holds 16 MiB or one
/// row, whichever is larger.
class ColumnFile {
 public:
  /// `widths`: number of floats of each column in a row. `beside`: as for `ScratchFile`.
  ColumnFile(const std::filesystem::path& beside, std::vector<std::size_t> widths);

  /// Appends a row: the floats of all columns, in column order.
  void append(std::span<const float> row);

  std::uint64_t rows() const { return rows_; }
  std::size_t width(std::size_t column) const { return widths_[column]; }
  std::size_t columns() const { return widths_.size(); }

  /// Passes a whole column to `take`, block by block. Precondition: `finish` was called.
  void read(std::size_t column, const std::function<void(std::span<const float>)>& take) const;
  void finish();

 private:
  void flush();

  ScratchFile file_;
  std::vector<std::size_t> widths_;
  std::vector<std::size_t> starts_;  ///< index of each column's first float in a row
  std::size_t row_floats_ = 0;
  std::size_t block_rows_ = 0;
  std::vector<float> block_;  ///< rows not yet written
  std::size_t waiting_ = 0;
  std::uint64_t rows_ = 0;
};

}  // namespace vestige
