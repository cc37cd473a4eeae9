#include "traces/files/column_file.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

namespace {

constexpr std::size_t kBlockFloats = std::size_t{1} << 22;

}  // namespace

ColumnFile::ColumnFile(const std::filesystem::path& beside, std::vector<std::size_t> widths)
    : file_(beside), widths_(std::move(widths)) {
  for (const std::size_t width : widths_) {
    starts_.push_back(row_floats_);
    row_floats_ += width;
  }
  block_rows_ = std::max<std::size_t>(1, kBlockFloats / std::max<std::size_t>(1, row_floats_));
  block_.reserve(block_rows_ * row_floats_);
}

void ColumnFile::append(std::span<const float> row) {
  block_.insert(block_.end(), row.begin(), row.end());
  ++rows_;
  if (++waiting_ == block_rows_) flush();
}

/// Writes the waiting rows as one block: first their values of the first column, then of the second, and so on.
void ColumnFile::flush() {
  std::vector<float> column;
  for (std::size_t c = 0; c < widths_.size(); ++c) {
    column.clear();
    for (std::size_t row = 0; row < waiting_; ++row) {
      const auto begin = block_.begin() + static_cast<std::ptrdiff_t>(row * row_floats_ + starts_[c]);
      column.insert(column.end(), begin, begin + static_cast<std::ptrdiff_t>(widths_[c]));
    }
    file_.append(std::as_bytes(std::span(column)));
  }
  block_.clear();
  waiting_ = 0;
}

void ColumnFile::finish() {
  if (waiting_ > 0) flush();
  block_.shrink_to_fit();
}

void ColumnFile::read(std::size_t column, const std::function<void(std::span<const float>)>& take) const {
  std::vector<float> values;
  for (std::uint64_t first = 0; first < rows_; first += block_rows_) {
    const std::uint64_t rows = std::min<std::uint64_t>(block_rows_, rows_ - first);
    values.resize(static_cast<std::size_t>(rows) * widths_[column]);
    const std::uint64_t offset = (first * row_floats_ + rows * starts_[column]) * sizeof(float);
    file_.read(offset, std::as_writable_bytes(std::span(values)));
    take(values);
  }
}

}  // namespace vestige
